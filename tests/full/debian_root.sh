# SPDX-License-Identifier: MIT
# shellcheck shell=sh
# Sourced: makes an empty Debian 12 root, $root, that is removed at exit. Needs root and the package
# archive that this machine's apt uses.

# make_root PACKAGE,...
make_root() {
    root=$(mktemp -d)
    chmod 755 "$root"  # users of the root pass through it too
    trap 'umount --recursive "$root/dev" "$root/proc" 2> /dev/null || true; rm -rf --one-file-system "$root"' EXIT INT TERM
    archive=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' | head -n 1)
    debootstrap --variant=minbase --include="$1" bookworm "$root" "$archive" > "$root.log" 2>&1 || {
        tail -n 20 "$root.log"; exit 1; }
    rm -f "$root.log"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    rm "$root/etc/apt/sources.list"
    cp -r /etc/apt/. "$root/etc/apt/"
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --make-rslave "$root/dev"
}
