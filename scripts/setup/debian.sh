# shellcheck shell=bash disable=SC2154,SC2034 # variables of lib.sh and setup.sh
# The Debian packages: those that are missing, from the lists in apt-packages*.txt.

missing_packages() { # EXTRA...: names, one a line
    local base=apt-packages lists extra
    [[ ! -d $noetic ]] || base=apt-packages-noetic
    lists=("$base.txt")
    for extra; do
        if [[ -e $base-$extra.txt ]]; then
            lists+=("$base-$extra.txt")
        elif [[ -e apt-packages-$extra.txt ]]; then
            lists+=("apt-packages-$extra.txt")
        fi
    done
    missing_in "${lists[@]}"
}

missing_in() { # LIST...
    local wanted
    mapfile -t wanted < <(sed 's/#.*//; s/ //g; /^$/d' "$@")
    comm -13 <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
        sed -n 's/^installed //p' | sort -u) <(printf '%s\n' "${wanted[@]}" | sort -u)
}

install_packages() { # NAME...
    local log=$logs/apt.log
    step "Installing Debian packages" "$log" apt_get "$@" && return
    if [[ -z $(reason_in "$log") ]] && grep -q 'Unable to locate package' "$log"; then
        fail "apt-get does not know all the packages: check that its sources hold Debian's 'main' or Ubuntu's 'universe' (see $log)"
    fi
    give_up "apt-get failed" "$log"
}

apt_get() { # NAME...
    local options=(-y --no-install-recommends -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3)
    local as_root=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive) name
    for name in http_proxy https_proxy no_proxy; do # sudo would drop them
        [[ -z ${!name:-} ]] || as_root+=("$name=${!name}")
    done
    # An interrupted installation is finished first: by dpkg only if apt-get refuses, since dpkg waits for nobody.
    # A source that is down matters only if a package comes from it.
    "${as_root[@]}" sh -c 'repair() { apt-get -f install "$@"; }; repair "$@" || { dpkg --configure -a && repair "$@"; }' \
        sh "${options[@]}" &&
        { "${as_root[@]}" apt-get update -o Acquire::Retries=3 || true; } &&
        "${as_root[@]}" apt-get install "${options[@]}" "$@"
}
