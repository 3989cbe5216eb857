#!/usr/bin/env bash
# Proves the two commands on a Debian 12 that holds nothing: makes one with debootstrap, clones the committed tree into it, and runs
# ./demo.sh and ./test.sh there, then the demo again without a network. Needs root, debootstrap and git.
#   tests/chroot.sh FOLDER     FOLDER is made, and kept: a second run starts from the packages it has
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
root=${1:-}
if [ -z "$root" ] || [ $# -ne 1 ]; then
  echo "usage: tests/chroot.sh FOLDER" >&2
  exit 2
fi
if [ "$(id -u)" -ne 0 ]; then
  echo "tests/chroot.sh: chroot needs root" >&2
  exit 1
fi

# The mirror that this machine itself installs from.
mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' | awk '$2 == "bookworm" {print $1; exit}')
if [ ! -x "$root/usr/bin/apt-get" ]; then
  debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
rm -rf "$root/rmac"
git clone --quiet --no-hardlinks "$source" "$root/rmac"

unmount() { umount -l "$root/dev/pts" "$root/dev/shm" "$root/proc" 2>/dev/null || true; }
trap unmount EXIT
mount -t proc proc "$root/proc"
mkdir -p "$root/dev/shm" "$root/dev/pts"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
ln -sf pts/ptmx "$root/dev/ptmx"
mount -t tmpfs tmpfs "$root/dev/shm"

# As the root of a mount namespace, not by chroot alone: the kernel gives no user namespace, which verification needs, to
# who was only changed root.
inside() { # command line
  unshare --mount bash -c '
    set -e
    mount --rbind "$1" "$1"
    cd "$1"
    pivot_root . .
    umount -l .
    exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 CI=true \
      chroot . bash -c "cd /rmac && $2"' bash "$root" "$1" </dev/null
}
inside ./demo.sh
inside ./test.sh
echo "== again, without a network"
export -f inside
export root
unshare --net bash -c "ip link set lo up && inside ./demo.sh"
echo "chroot.sh: demo and tests pass in a fresh Debian 12"
