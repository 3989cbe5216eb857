# Sourced or run inside the emulated machine: a simulated GPIO chip with the label io, of 8 lines. boot.sh brought its module.
busybox insmod "$GPIO_SIM"
io=/sys/kernel/config/gpio-sim/io
mkdir -p $io/bank0
echo 8 > $io/bank0/num_lines
echo io > $io/bank0/label
line=0
for name in estop-nc estop-no probe coolant release; do
  mkdir $io/bank0/line$line
  echo $name > $io/bank0/line$line/name
  line=$((line + 1))
done
echo 1 > $io/live
