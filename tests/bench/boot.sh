#!/bin/bash
# Boots a Debian kernel in QEMU over this machine's own root file system (read-only, under an overlay), runs a script in it,
# prints its console, and ends with the script's exit code. The kernel is fetched once and unpacked, not installed.
# usage: [FLAVOUR=rt-amd64] [KERNELS=DIR] [INIT=systemd] boot.sh GUEST_SCRIPT [ARGUMENT]
# With INIT=systemd the script runs as a service beside those that it starts; otherwise it is all that runs.
# The guest's clock counts instructions (1 ns each), so that what happens in it does not depend on how busy the machine is.
set -euo pipefail
flavour=${FLAVOUR:-amd64} kernels=${KERNELS:-${XDG_CACHE_HOME:-$HOME/.cache}/rmac-bench} guest=$(realpath "$1") argument=${2:-}
kernel=$kernels/$flavour
"$(dirname "$0")/fetch-kernel.sh"
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/root/{bin,proc,sys,dev,m}
cp /bin/busybox "$work/root/bin/"
for module in virtio virtio_ring virtio_pci virtio_pci_modern_dev virtio_pci_legacy_dev netfs fscache 9pnet 9pnet_virtio 9p overlay configfs can can-raw can-dev vcan; do
  find "$kernel/lib/modules" -name "$module.ko" -exec cp {} "$work/root/m/" \;
done
[[ ! -e $kernel/gpio-sim.ko ]] || cp "$kernel/gpio-sim.ko" "$work/root/"  # where gpio-sim.sh made one
cat > "$work/root/bench.service" <<S
[Unit]
Description=Scenario of the bench
[Service]
Type=oneshot
Environment=GPIO_SIM=/run/gpio-sim.ko PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
ExecStart="$guest" "$argument"
ExecStopPost=/bin/sh -c 'echo "guest exit \$EXIT_STATUS"; sleep 0.2; echo o > /proc/sysrq-trigger'
StandardOutput=tty
StandardError=tty
TTYPath=/dev/console
S
cat > "$work/root/init" <<'I'
#!/bin/busybox sh
b=/bin/busybox
$b mount -t proc proc /proc; $b mount -t sysfs sys /sys; $b mount -t devtmpfs dev /dev
# Three passes load modules in whatever order they need each other.
for pass in 1 2 3; do for f in /m/*.ko; do $b insmod $f 2>/dev/null; done; done
$b mkdir -p /lower /over /sysroot
$b mount -t 9p -o trans=virtio,version=9p2000.L,msize=512000,ro,cache=loose rootfs /lower
$b mount -t tmpfs tmpfs /over; $b mkdir /over/up /over/work
$b mount -t overlay overlay -o lowerdir=/lower,upperdir=/over/up,workdir=/over/work /sysroot
for fs in proc sysfs:sys devtmpfs:dev tmpfs:run tmpfs:dev/shm devpts:dev/pts configfs:sys/kernel/config; do
  $b mkdir -p /sysroot/${fs#*:}; $b mount -t ${fs%%:*} none /sysroot/${fs#*:}
done
for word in $($b cat /proc/cmdline); do
  case $word in guest=*) guest=${word#guest=};; argument=*) argument=${word#argument=};; with=*) with=${word#with=};; esac
done
[ ! -e /gpio-sim.ko ] || $b cp /gpio-sim.ko /sysroot/run/
echo  # what the firmware wrote ends without an end of line
if [ "$with" = systemd ]; then
  $b rm -f /sysroot/etc/fstab
  $b cp /bench.service /sysroot/etc/systemd/system/
  # It would empty /tmp, which is the host's, and where this may lie.
  $b ln -sf /dev/null /sysroot/etc/systemd/system/systemd-tmpfiles-setup.service
  exec $b switch_root /sysroot /lib/systemd/systemd --unit=bench.service
fi
# Not by chroot: who was only changed root gets no user namespace, in which modules are verified.
exec $b switch_root /sysroot /usr/bin/env GPIO_SIM=/run/gpio-sim.ko PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
  /bin/sh -c '"$1" "$2"; echo "guest exit $?"; echo o > /proc/sysrq-trigger; sleep 5' sh "$guest" "$argument"
I
chmod +x "$work/root/init"
(cd "$work/root" && find . | cpio -o -H newc --quiet | gzip -1) > "$work/initrd.gz"
timeout "${LIMIT:-600}" qemu-system-x86_64 -M q35 -cpu max -accel tcg,thread=single -icount shift=0,sleep=off -smp 1 -m 1G \
  -nographic -nic none -no-reboot -kernel "$kernel"/boot/vmlinuz-* -initrd "$work/initrd.gz" \
  -append "console=ttyS0 quiet panic=-1 mitigations=off nokaslr guest=$guest argument=$argument with=${INIT:-nothing} systemd.show_status=false" \
  -fsdev local,id=r,path=/,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=r,mount_tag=rootfs |
  stdbuf -o0 tr -d '\r' | tee "$work/console"
exit "$(awk '/^guest exit / {code = $3} END {print code == "" ? 1 : code}' "$work/console")"
