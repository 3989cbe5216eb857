#!/bin/bash
# Builds the kernel's own simulated GPIO chip, which Debian leaves out of its kernels, for the kernel that boot.sh fetched.
# usage: [FLAVOUR=rt-amd64] [KERNELS=DIR] gpio-sim.sh      leaves KERNELS/FLAVOUR/gpio-sim.ko; installs the kernel's headers, so it needs root
set -euo pipefail
flavour=${FLAVOUR:-amd64} kernels=${KERNELS:-${XDG_CACHE_HOME:-$HOME/.cache}/rmac-bench}
kernel=$kernels/$flavour
[[ ! -e $kernel/gpio-sim.ko ]] || exit 0
release=$(basename "$kernel"/lib/modules/*)
apt-get install -y -qq --no-install-recommends "linux-headers-$release" make gcc xz-utils >/dev/null
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get download -qq linux-source-6.1
dpkg-deb -x linux-source-6.1_*.deb .
source=linux-source-6.1
tar -xJf usr/src/$source.tar.xz $source/drivers/gpio/{gpio-sim.c,gpiolib.h} $source/kernel/irq/irq_sim.c
mkdir module
cp $source/drivers/gpio/gpiolib.h module/
cp $source/drivers/gpio/gpio-sim.c module/gpio-sim-main.c
# The simulated interrupts are left out, too: they go into the module, which may not use names that the kernel does not export.
sed -e '/EXPORT_SYMBOL/d' -e 's/handle_simple_irq(irq_to_desc(\(.*\)));/generic_handle_irq(\1);/' $source/kernel/irq/irq_sim.c > module/irq_sim.c
printf 'obj-m := gpio-sim.o\ngpio-sim-y := gpio-sim-main.o irq_sim.o\n' > module/Makefile
make -s -C "/usr/src/linux-headers-$release" M="$work/module" modules
mv module/gpio-sim.ko "$kernel/"
