# Releases of Debian and Ubuntu in folders, for scripts run as root: root_make, root_run, root_leave.
# ROOT_MIRROR: where packages come from. ROOT_KEEP: a folder that keeps the minimal systems for the next time.

# root_bootstrap SUITE FOLDER. Ubuntu has a mirror of its own, wants universe beside main, and is set up the same way in all releases,
# which a debootstrap of Debian's does not know by name.
root_bootstrap() {
    case $1 in
    jammy | noble | questing | resolute)
        debootstrap --variant=minbase --components=main,universe "$1" "$2" "${ROOT_MIRROR-http://archive.ubuntu.com/ubuntu}" gutsy ;;
    *) debootstrap --variant=minbase "$1" "$2" "${ROOT_MIRROR-http://deb.debian.org/debian}" ;;
    esac
}

# root_make SUITE FOLDER PACKAGE...: a minimal system with the packages named, and /proc and /dev mounted.
root_make() {
    suite=$1 root=$2
    shift 2
    if [ -n "${ROOT_KEEP-}" ] && [ -d "$ROOT_KEEP/$suite" ]; then
        cp -a "$ROOT_KEEP/$suite" "$root"
    else
        root_bootstrap "$suite" "$root" >"$root.log" 2>&1 || {
            tail -5 "$root.log" >&2
            return 1
        }
        [ -z "${ROOT_KEEP-}" ] || cp -a "$root" "$ROOT_KEEP/$suite"
    fi
    cp /etc/resolv.conf "$root/etc"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/throwaway" # nothing here must outlive a power failure
    mount -t proc proc "$root/proc" && mount --bind /dev "$root/dev" || return 1
    root_run "$root" 0:0 "apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $*" >"$root.log" 2>&1 || {
        tail -5 "$root.log" >&2
        return 1
    }
}

# root_run FOLDER USER COMMAND: a shell in it, with nothing of our environment; an ordinary user has no HOME.
root_run() {
    chroot --userspec="$2" "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 sh -c "$3"
}

# root_leave FOLDER: unmounts, then removes it; nothing is removed while something is mounted below.
root_leave() {
    for m in proc dev; do umount "$1/$m" 2>/dev/null || true; done
    if grep -q " $1/" /proc/mounts; then
        echo "still mounted: $1" >&2
        return 1
    fi
    rm -rf --one-file-system "$1" "$1.log"
}

# root_here: whether this machine and user can do it; says why not.
root_here() {
    [ "$(id -u)" = 0 ] || { echo "needs root, for debootstrap and chroot"; return 1; }
    command -v debootstrap >/dev/null 2>&1 || { echo "needs debootstrap"; return 1; }
}
