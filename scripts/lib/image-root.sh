#!/bin/sh
# Creates the root folder of the container's image: the archive that scripts/release built, and only
# the necessary files of the system. The Dockerfile and scripts/test-release --image run it in a
# Debian with zstd and ca-certificates.
#
#   image-root.sh ARCHIVE FOLDER
set -eu

if [ $# -ne 2 ] || [ ! -f "$1" ]; then
    echo "error: give one archive and one folder to create, not: $*; keep only one corniche-*-x86_64-linux.tar.zst in target/release-archive" >&2
    exit 2
fi
archive=$1 root=$2
mkdir -p "$root/opt" "$root/bin" "$root/etc/ssl/certs" "$root/lib64" "$root/proc" "$root/tmp" "$root/data"
zstd -dc --long=27 "$archive" | tar -C "$root/opt" -xf -
mv "$root"/opt/corniche-* "$root/opt/corniche"
ln -s ../opt/corniche/bin/corniche "$root/bin/corniche"
# The C library, its loader and the modules that resolve host names; the C++ library.
for name in libc.so.6 libm.so.6 libpthread.so.0 libdl.so.2 librt.so.1 libresolv.so.2 libnss_dns.so.2 libnss_files.so.2 libstdc++.so.6 libgcc_s.so.1; do
    file=$(find /lib/x86_64-linux-gnu/ /usr/lib/x86_64-linux-gnu/ -name "$name" | head -n 1)
    mkdir -p "$root/lib/x86_64-linux-gnu"
    cp -L "$file" "$root/lib/x86_64-linux-gnu/$name"
done
cp -L /lib64/ld-linux-x86-64.so.2 "$root/lib64/"
cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
echo 'corniche:x:1000:1000::/data:/bin/false' >"$root/etc/passwd"
echo 'corniche:x:1000:' >"$root/etc/group"
echo 'hosts: files dns' >"$root/etc/nsswitch.conf"
mkdir -p "$root/opt/corniche/share/corniche/licences/debian"
for package in libc6 libstdc++6 ca-certificates; do cp "/usr/share/doc/$package/copyright" "$root/opt/corniche/share/corniche/licences/debian/$package.txt"; done
chown 1000:1000 "$root/data"
chmod 1777 "$root/tmp"
