#!/bin/bash
# Fetches the kernel that boot.sh boots, once: unpacked under KERNELS, not installed.
# usage: [FLAVOUR=rt-amd64] [KERNELS=DIR] fetch-kernel.sh
set -euo pipefail
flavour=${FLAVOUR:-amd64} kernels=${KERNELS:-${XDG_CACHE_HOME:-$HOME/.cache}/rmac-bench}
[[ ! -d $kernels/$flavour ]] || exit 0
mkdir -p "$kernels"
cd "$kernels"
package=$(apt-cache depends "linux-image-$flavour" | awk '/Depends: linux-image-[0-9]/ {print $2; exit}')
apt-get download -qq "$package"
dpkg-deb -x "$package"_*.deb "$flavour.part"
rm "$package"_*.deb
mv "$flavour.part" "$flavour"
