# shellcheck shell=bash disable=SC2154,SC2034 # variables of lib.sh and setup.sh
# The Python packages in .venv: fetched as wheels while Debian's are installed, then installed without network.
# New packages are installed into .venv, where they change no other. Other versions of installed packages are installed
# into .venv.new, a copy that then replaces .venv.

venv=$root/.venv # the environment that pip installs into
patience=60      # seconds to wait for running programs to end before packages change

missing_requirements() { # FILE...: those that are not installed in .venv
    local file
    for file; do
        grep -qsxF "$(requirement_stamp "$file")" "$root/.venv/.set-up" || print_line "$file"
    done
}

requirement_stamp() { # FILE
    print_line "$(sha256sum "$1") $(maker)"
}

requirement_names() {
    local files
    mapfile -t files <<<"$requirements"
    (cd "$root/scripts" && sed -n 's/==.*//p' "${files[@]}" | uniq | paste -sd, | sed 's/,/, /g')
}

make_venv() {
    check_python
    : >"$logs/python.log"
    if replaces_packages; then
        wait_until_unused
        venv=$root/.venv.new
        if is_venv_whole "$root/.venv"; then copy_venv; fi
    fi
    is_venv_whole "$venv" || has_stamp "$venv/.made" "$(maker)" ||
        step "Creating .venv" "$logs/python.log" create_venv ||
        give_up "the virtual environment could not be created" "$logs/python.log"
}

is_venv_whole() { # VENV: created here, with this Python, and completely installed
    grep -qs " $(maker)\$" "$1/.set-up"
}

maker() { print_line "$root $(readlink /usr/bin/python3)"; }

create_venv() {
    /usr/bin/python3 -m venv --clear --system-site-packages "$venv" && maker >"$venv/.made"
}

copy_venv() { # hard links: pip replaces files and never writes into one
    rm -rf "$venv"
    cp -al "$root/.venv" "$venv" 2>/dev/null || { rm -rf "$venv" && cp -a "$root/.venv" "$venv"; }
}

use_venv() { # replace .venv by the copy; programs in it contain its path
    [[ $venv != "$root/.venv" ]] || return 0
    { grep -lIrF "$venv" "$venv/bin" "$venv/pyvenv.cfg" || true; } | xargs -r sed -i "s|$venv|$root/.venv|g"
    exchange "$root/.venv" "$venv"
    rm -rf "$venv"
    venv=$root/.venv
}

restore_venv() { # after a set-up that was interrupted during the exchange, or one of version 1.0.0
    local here=$root/.venv
    [[ -e $here || ! -e $here.old ]] || mv -T "$here.old" "$here"
    [[ -e $here/.set-up || ! -e $here/.set-up.before ]] || mv "$here/.set-up.before" "$here/.set-up"
}

replaces_packages() { # is a missing requirement installed in another version?
    local file
    for file in $requirements; do ! grep -qs "  $file " "$root/.venv/.set-up" || return 0; done
    return 1
}

wait_until_unused() {
    ! is_in_use || step "Waiting for what runs in this workspace to end, as its Python packages change" /dev/null \
        await_end || fail "the Python packages have changed: end what runs in this workspace, then start again"
}

await_end() {
    local end=$((SECONDS + patience))
    while is_in_use; do
        ((SECONDS < end)) || return 1
        sleep 0.2
    done
}

is_in_use() { # each running program holds a lock on its build
    local space
    for space in "$root"/build/[0-9]*/; do
        [[ ! -d $space ]] || flock --nonblock "$space" true || return 0
    done
    return 1
}

fetch_requirements() { # those that are missing
    [[ -z $(missing_wheel) ]] || build_wheel || return
    local files
    mapfile -t files < <(options_of_missing)
    # Packages without wheels are built in pip's isolated environment: Debian 11 lacks wheel and has a patched distutils.
    SETUPTOOLS_USE_DISTUTILS=stdlib pip wheel --use-pep517 --no-deps --wheel-dir "$venv/wheels" \
        --find-links "$wheels" "${files[@]}"
}

install_requirements() {
    local stamp=$venv/.set-up files file
    mapfile -t files < <(options_of_missing)
    remove_half_installed
    pip install --no-index --find-links "$venv/wheels" "${files[@]}" || return
    rm -rf "$venv/wheels"
    (
        cd "$root/scripts" || exit
        stamps_of_others "$stamp"
        for file in "${requirement_files[@]}"; do requirement_stamp "$file"; done
    ) | sort -u >"$stamp.new"
    mv "$stamp.new" "$stamp"
    use_venv
}

remove_half_installed() { # pip accepts a package that is installed in part; it writes the file INSTALLER last
    local package
    for package in "$venv"/lib/python3.*/site-packages/*.dist-info; do
        [[ ! -d $package || -e $package/INSTALLER ]] || rm -rf "$package"
    done
}

stamps_of_others() { # FILE: stamps of the other requirements, which stay installed
    local names
    names=$(IFS='|' && printf '%s' "${requirement_files[*]}")
    grep -svE "  ($names) " "$1" || true
}

rospy_of_system=/usr/lib/python3/dist-packages/rospy

shield_rospy() { # Debian 11's calls Thread.isAlive, which its Python lacks, at the second subscription
    grep -qs 'isAlive()' "$rospy_of_system/core.py" || return 0
    local site
    site=$(echo "$root"/.venv/lib/python3.*/site-packages)
    [[ ! -d $site ]] ||
        print_line 'import threading; threading.Thread.isAlive = threading.Thread.is_alive' >"$site/rospy_shield.pth"
}

options_of_missing() {
    local names
    mapfile -t names <<<"$requirements"
    printf '%s\n' "${names[@]/#/--requirement=$root/scripts/}"
}

pip() { pip_of "$venv" "$@"; }

pip_of() { # VENV COMMAND ARGUMENT...: without Debian's Python packages, which change while apt-get runs
    env -u PYTHONHOME -u PYTHONPATH "$1/bin/python3" -c '
import runpy, sys
sys.path = [path for path in sys.path if not path.endswith("dist-packages")]
runpy.run_module("pip", run_name="__main__")' "$2" --no-input --disable-pip-version-check --retries 3 "${@:3}"
}

# -- PyBullet, if PyPI has no wheel for this machine: built once for all workspaces of this user ----------

wheels=${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/home-service-robot/wheels/$(getconf GNU_LIBC_VERSION | tr ' ' -)

missing_wheel() { # its name, if it is needed and neither PyPI nor the cache has one for this machine
    local tag
    grep -qx requirements.txt <<<"$requirements" || return 0
    tag=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])') || return 0
    if [[ $(uname -m) == x86_64 ]] && is_among "$tag" cp38 cp39 cp310 cp311; then return 0; fi
    has_whole_wheel "$wheels/pybullet-$(pybullet_version)-$tag-"*"$(uname -m).whl" || print_line "pybullet for $tag"
}

has_whole_wheel() { # FILE: a zip file has its table of contents at its end
    [[ -e $1 ]] && /usr/bin/python3 -m zipfile --list "$1" >/dev/null 2>&1
}

pybullet_version() { sed -n 's/^pybullet==//p' "$root/scripts/requirements.txt"; }

build_wheel() ( # moved into the cache when it is complete
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
