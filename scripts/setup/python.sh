# shellcheck shell=bash disable=SC2154,SC2034 # variables of lib.sh and setup.sh
# The Python packages in .venv: fetched beside Debian's, each as a wheel, then installed without network.

missing_requirements() { # FILE...: those that .venv does not hold
    local file
    for file; do
        grep -qsxF "$(requirement_stamp "$file")" "$root/.venv/.set-up" || print_line "$file"
    done
}

requirement_stamp() { # FILE
    print_line "$(sha256sum "$1") $root $(readlink /usr/bin/python3)"
}

requirement_names() {
    local files
    mapfile -t files <<<"$requirements"
    (cd "$root/scripts" && sed -n 's/==.*//p' "${files[@]}" | uniq | paste -sd, | sed 's/,/, /g')
}

make_venv() {
    check_python
    : >"$logs/python.log"
    if is_venv_whole; then
        mv "$root/.venv/.set-up" "$root/.venv/.set-up.before" # other extras stay installed
        return
    fi
    step "Creating .venv" "$logs/python.log" \
        /usr/bin/python3 -m venv --clear --system-site-packages "$root/.venv" ||
        give_up "the virtual environment could not be created" "$logs/python.log"
}

is_venv_whole() { # made here, with this Python, and never left half installed
    grep -qs " $root $(readlink /usr/bin/python3)\$" "$root/.venv/.set-up"
}

fetch_requirements() { # those that are missing, into .venv/wheels
    [[ -z $(missing_wheel) ]] || build_wheel || return
    local files
    mapfile -t files < <(options_of_missing)
    # Packages without wheels are built in pip's isolated environment: Debian 11 lacks wheel and has a patched distutils.
    SETUPTOOLS_USE_DISTUTILS=stdlib pip wheel --use-pep517 --no-deps --wheel-dir "$root/.venv/wheels" \
        --find-links "$wheels" "${files[@]}"
}

install_requirements() {
    local stamp=$root/.venv/.set-up files file
    mapfile -t files < <(options_of_missing)
    pip install --no-index --find-links "$root/.venv/wheels" "${files[@]}" || return
    rm -rf "$root/.venv/wheels"
    (
        cd "$root/scripts" || exit
        stamps_of_others "$stamp.before"
        for file in "${requirement_files[@]}"; do requirement_stamp "$file"; done
    ) | sort -u >"$stamp.new"
    mv "$stamp.new" "$stamp"
    rm -f "$stamp.before"
}

stamps_of_others() { # FILE: of requirements that are not set up now, which stay installed
    local names
    names=$(IFS='|' && printf '%s' "${requirement_files[*]}")
    grep -svE "  ($names) " "$1" || true
}

rospy_of_system=/usr/lib/python3/dist-packages/rospy

shield_rospy() { # that of Debian 11 calls Thread.isAlive, which its Python no longer has, when a second topic is subscribed to
    grep -qs 'isAlive()' "$rospy_of_system/core.py" || return 0
    local site
    site=$(echo "$root"/.venv/lib/python3.*/site-packages)
    print_line 'import threading; threading.Thread.isAlive = threading.Thread.is_alive' >"$site/rospy_shield.pth"
}

options_of_missing() {
    local names
    mapfile -t names <<<"$requirements"
    printf '%s\n' "${names[@]/#/--requirement=$root/scripts/}"
}

pip() { pip_of "$root/.venv" "$@"; }

pip_of() { # VENV COMMAND ARGUMENT...: what Debian has does not count, it comes and goes while apt-get is at work
    env -u PYTHONHOME -u PYTHONPATH "$1/bin/python3" -c '
import runpy, sys
sys.path = [path for path in sys.path if not path.endswith("dist-packages")]
runpy.run_module("pip", run_name="__main__")' "$2" --no-input --disable-pip-version-check --retries 3 "${@:3}"
}

# -- PyBullet, where its makers have no wheel: built once, for all workspaces of this user ---------------

wheels=${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/home-service-robot/wheels/$(getconf GNU_LIBC_VERSION | tr ' ' -)

missing_wheel() { # its name, if it is needed and neither PyPI nor the cache has one for this machine
    local tag
    grep -qx requirements.txt <<<"$requirements" || return 0
    tag=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])') || return 0
    if [[ $(uname -m) == x86_64 ]] && is_among "$tag" cp38 cp39 cp310 cp311; then return 0; fi
    has_whole_wheel "$wheels/pybullet-$(pybullet_version)-$tag-"*"$(uname -m).whl" || print_line "pybullet for $tag"
}

has_whole_wheel() { # FILE: its table of contents is at its end
    [[ -e $1 ]] && /usr/bin/python3 -m zipfile --list "$1" >/dev/null 2>&1
}

pybullet_version() { sed -n 's/^pybullet==//p' "$root/scripts/requirements.txt"; }

build_wheel() ( # moved into the cache when it is whole
    work=
    trap '[[ -z $work ]] || rm -rf "$work"' EXIT
    mkdir -p "$wheels" && work=$(mktemp -d "$wheels/.building.XXXXXX") || exit
    /usr/bin/python3 -m venv "$work/venv" &&
        pip_of "$work/venv" install --constraint "$root/scripts/requirements.txt" numpy \
            --requirement "$root/scripts/requirements-wheel.txt" &&
        CFLAGS='-Wno-error=incompatible-pointer-types -O2' CXXFLAGS=-O2 MAX_JOBS=$(nproc) \
            pip_of "$work/venv" wheel --no-deps --no-build-isolation --no-binary pybullet \
            --wheel-dir "$work" "pybullet==$(pybullet_version)" &&
        mv "$work"/pybullet-*.whl "$wheels"
)
