#!/usr/bin/env bash
# on_debian.sh SUITE [TESTS...]: the wheel on the Python of a Debian suite, such as trixie (3.13) or
# sid, in a tree of its own that debootstrap fills; as root. Tests run from the source distribution
# on the installed wheel. DIST is a folder of `uv build`, ROOTS where the trees are kept.
set -euo pipefail
suite=$1; shift
dist=${DIST:-dist} root=${ROOTS:-/tmp/debian}/$suite
[ -x "$root/usr/bin/python3" ] || debootstrap --variant=minbase \
    --include=python3,python3-venv,ca-certificates,libgomp1 "$suite" "$root" http://deb.debian.org/debian
rm -rf "$root/try"; mkdir "$root/try"
tar xzf "$dist"/dh2urdf-*.tar.gz -C "$root/try" --strip-components 1
rm -r "$root/try/dh2urdf"
cp "$dist"/dh2urdf-*.whl "$root/try/"
cp /etc/resolv.conf /etc/hosts "$root/etc/"
cp -L "${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}" "$root/etc/ssl/certs/ca-certificates.crt"
[ -e "$root/dev/null" ] && [ -c "$root/dev/urandom" ] || { mknod -m 666 "$root/dev/null" c 1 3; mknod -m 666 "$root/dev/urandom" c 1 9; }
mountpoint -q "$root/proc" || { mount -t proc proc "$root/proc"; trap 'umount "$root/proc"' EXIT; }
chroot "$root" env -i HOME=/root PATH=/usr/bin:/bin LANG=C.UTF-8 PIP_NO_CACHE_DIR=1 \
    SSL_CERT_FILE=/etc/ssl/certs/ca-certificates.crt DH2URDF_ENGINE=compiled bash -euo pipefail -c '
cd /try
[ -x /venv/bin/python ] || python3 -m venv /venv
/venv/bin/pip install -q "$(echo dh2urdf-*.whl)[test,all]"
/venv/bin/pip install -q --no-deps --force-reinstall dh2urdf-*.whl
/venv/bin/python --version
PATH=/venv/bin:$PATH
dh2urdf convert denso_vs6556 -o denso.urdf --force
dh2urdf ik denso_vs6556 --xyz 0.4 0 0.3 --rpy 0 180 0 --deg
[ $# -eq 0 ] || python -m pytest -q -p no:cacheprovider "$@"
' bash "$@"
