#!/usr/bin/env bash
# Usage: ./scripts/setup.sh [--dev] [--projects] [--rviz] [--packages]
#
# Installs what the workspace needs and is missing: Debian packages (as root or with sudo), Python packages
# in .venv, the catkin build in build/ and devel/. The other scripts do this themselves when they start.
# Does nothing when all is there, and goes on where an interrupted set-up ended. Logs: logs/setup/.
#
#   --dev        also what the checks in .ci/run and the benchmarks need: ruff, mypy, matplotlib ...
#   --projects   also what run_project.sh needs: libraries for projects in C++
#   --rviz       also rviz
#   --packages   only the Debian and Python packages, as for a cached layer of an image
#   --help       this text

# shellcheck source=scripts/lib.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/lib.sh"

readonly logs=$root/logs/setup
packages_only=

set_up() { # EXTRA...: brings the workspace up to date; extras are dev and rviz
    look_for_missing "$@"
    [[ -n $packages$requirements$build$kernels ]] || return 0
    check_place
    mkdir -p "$logs"
    take_turns
    look_for_missing "$@"
    announce
    [[ -z $packages ]] || install_packages
    [[ -z $requirements ]] || install_requirements
    [[ -z $packages_only ]] || return 0
    [[ -z $build ]] || build_workspace
    [[ -z $kernels ]] || compile_kernels
    exec 9<&- # what is run now must not keep others from setting up
}

# -- what is missing: each variable is empty when nothing is -------------------------------------------

look_for_missing() { # EXTRA...
    requirement_files=(requirements.txt)
    local extra
    for extra; do
        [[ ! -e $root/scripts/requirements-$extra.txt ]] || requirement_files+=("requirements-$extra.txt")
    done
    requirements=$(cd "$root/scripts" && missing_requirements "${requirement_files[@]}")
    build=
    [[ -z $requirements ]] && has_stamp "$root/build/.set-up" "$(build_inputs)" || build=workspace
    kernels=
    [[ -z $build ]] && has_stamp "$root/build/.kernels" "$(kernel_inputs)" || kernels=kernels
    packages=$(cd "$root/scripts" && missing_packages "$@" ${build:+build})
}

has_stamp() { [[ -e $1 && $(<"$1") == "$2" ]]; } # FILE TEXT

missing_packages() { # EXTRA...: names, one a line
    local base=apt-packages lists wanted extra
    [[ ! -d $noetic ]] || base=apt-packages-noetic
    lists=("$base.txt")
    for extra; do
        if [[ -e $base-$extra.txt ]]; then lists+=("$base-$extra.txt"); else lists+=("apt-packages-$extra.txt"); fi
    done
    mapfile -t wanted < <(sed 's/#.*//; s/ //g; /^$/d' "${lists[@]}")
    comm -13 <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
        sed -n 's/^installed //p' | sort) <(printf '%s\n' "${wanted[@]}" | sort)
}

missing_requirements() { # FILE...: those that .venv does not hold
    local file
    for file; do
        grep -qsxF "$(requirement_stamp "$file")" "$root/.venv/.set-up" || say "$file"
    done
}

requirement_stamp() { # FILE
    say "$(sha256sum "$1") $root $(readlink /usr/bin/python3)"
}

build_inputs() { # two lines: which packages there are, and what the build reads
    cd "$root" || return
    find src -name package.xml | sort | cat - <(say "$root") <(compat_packages_of_system) | sha256sum
    find -L src -mindepth 2 -type f \( -name package.xml -o -name CMakeLists.txt -o -name setup.py -o -path '*/nodes/*' \
        -o -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -name '*.cfg' \
        -o -name '*.c' -o -name '*.cpp' -o -name '*.h' -o -name '*.hpp' \) ! -path '*/__pycache__/*' -print0 |
        sort -z | xargs -0 sha256sum | sha256sum
}

kernel_inputs() { (cd "$root" && grep -rl --include='*.py' numba src | sort | xargs -r stat -c '%n %Y %s' | sha256sum); }

# -- what can be told before anything is changed -------------------------------------------------------

check_place() {
    local refused='[][:space:]"$;:\*?<>|!{}`&()#'"'[]"
    if [[ $root =~ $refused ]]; then
        fail "catkin cannot build in '$root': move the project to a path without spaces and special characters"
    fi
    ((${#root} < 200)) || fail "catkin cannot build in a path of ${#root} characters: move the project to a shorter one"
    [[ -w $root ]] || fail "'$root' is read-only, and the workspace in it is not set up: make it writable"
    if [[ -n $packages ]]; then
        check_system
        check_root
    fi
}

check_system() {
    local ID=unknown VERSION_ID='' PRETTY_NAME=''
    # shellcheck source=/dev/null
    [[ ! -r /etc/os-release ]] || . /etc/os-release
    [[ -d $noetic || $ID-$VERSION_ID == debian-12 ]] ||
        fail "this is ${PRETTY_NAME:-$ID}: the workspace needs Debian 12, or ROS Noetic in $noetic"
}

check_root() {
    sudo=()
    ((EUID)) || return 0
    local list="Debian packages are missing (${packages//$'\n'/ })"
    command -v sudo >/dev/null || fail "$list: run this as root, or install sudo"
    sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; } || fail "$list: run this as root, or where sudo lets you"
    sudo=(sudo)
}

check_python() {
    /usr/bin/python3 -c 'import sys; sys.exit(not (3, 8) <= sys.version_info[:2] <= (3, 11))' 2>/dev/null ||
        fail "/usr/bin/python3 is $(/usr/bin/python3 --version 2>&1 || true): the workspace needs Python 3.8 to 3.11"
}

take_turns() { # one set-up at a time; the lock ends with the set-up, or with the last process of one cut short
    exec 9<"$root/scripts/setup.sh"
    flock --nonblock 9 || step "Waiting for another set-up of this workspace" /dev/null flock 9
}

announce() {
    say "Setting up the workspace in $root (once; logs in logs/setup/):"
    [[ -z $packages ]] || say "  Debian packages, with apt-get: ${packages//$'\n'/ }"
    [[ -z $requirements ]] || say "  Python packages, into .venv: $(requirement_names)"
    [[ -z $packages_only ]] || return 0
    [[ -z $build ]] || say "  catkin build, into build/ and devel/"
    [[ -z $kernels ]] || say "  compiled numerical kernels, into __pycache__ folders of src/"
}

requirement_names() {
    local files
    mapfile -t files <<<"$requirements"
    (cd "$root/scripts" && sed -n '/;/d; s/==/ /p' "${files[@]}" | paste -sd, | sed 's/,/, /g')
}

# -- the steps -----------------------------------------------------------------------------------------

install_packages() {
    local log=$logs/apt.log names
    mapfile -t names <<<"$packages"
    : >"$log"
    step "Installing Debian packages" "$log" apt_get "${names[@]}" && return
    if grep -qE 'Temporary failure|Could not (resolve|connect)|Unable to connect|Network is unreachable' "$log"; then
        fail "no network: the Debian packages could not be downloaded (see $log)"
    fi
    if grep -q 'Unable to locate package' "$log"; then
        fail "apt-get does not know all the packages: check that its sources hold Debian 12 'main' (see $log)"
    fi
    give_up "apt-get failed" "$log"
}

apt_get() { # NAME...
    local options=(-y --no-install-recommends -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3)
    # An interrupted installation is finished first; a source that is down matters only if a package comes from it.
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive sh -c '
        dpkg --configure -a && apt-get -f install "$@"' sh "${options[@]}" &&
        { "${sudo[@]}" apt-get update -o Acquire::Retries=3 || true; } &&
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install "${options[@]}" "$@"
}

install_requirements() {
    local log=$logs/python.log stamp=$root/.venv/.set-up files file
    check_python
    : >"$log"
    if ! is_venv_whole; then
        step "Creating .venv" "$log" /usr/bin/python3 -m venv --clear --system-site-packages "$root/.venv" ||
            give_up "the virtual environment could not be created" "$log"
    fi
    rm -f "$stamp" "$root/build/.set-up"
    files=("${requirement_files[@]/#/--requirement=$root/scripts/}")
    step "Installing Python packages" "$log" pip_install "${files[@]}" || pip_failed "$log"
    (cd "$root/scripts" && for file in "${requirement_files[@]}"; do requirement_stamp "$file"; done) >"$stamp.new"
    mv "$stamp.new" "$stamp"
}

is_venv_whole() { # made here, with this Python, and never left half installed
    grep -qs " $root $(readlink /usr/bin/python3)\$" "$root/.venv/.set-up"
}

pip_install() {
    env -u PYTHONHOME -u PYTHONPATH "$root/.venv/bin/python3" -m pip install --no-input \
        --disable-pip-version-check --retries 3 "$@"
}

pip_failed() { # LOG
    if grep -qE 'Temporary failure|NewConnectionError|ConnectTimeout|Network is unreachable' "$1"; then
        fail "no network: the Python packages could not be downloaded (see $1)"
    fi
    give_up "pip failed" "$1"
}

build_workspace() {
    local log=$logs/build.log stamp=$root/build/.set-up inputs
    inputs=$(build_inputs)
    : >"$log"
    # A build that was cut short, made elsewhere, or holds packages that have gone is made anew.
    if [[ ! -e $stamp || $(head -n 1 "$stamp") != "${inputs%%$'\n'*}" ]]; then
        clear_build
    fi
    rm -f "$stamp"
    step "Building the workspace" "$log" catkin_build || give_up "the catkin build failed" "$log"
    say "$inputs" >"$stamp"
}

clear_build() { # but for other people's projects that run at this moment: each holds the lock in its folder
    local folder
    for folder in "$root"/build/projects/*/; do
        [[ ! -d $folder ]] || flock --nonblock "$folder/lock" rm -rf "$folder" ||
            say "left alone, in use: $folder"
    done
    [[ ! -d $root/build ]] || find "$root/build" -mindepth 1 -maxdepth 1 ! -name projects -exec rm -rf {} +
    rm -rf "$root/devel"
}

catkin_build() {
    # The workspace stands alone: another one that is sourced here must not become part of it.
    unset CMAKE_PREFIX_PATH LD_LIBRARY_PATH PKG_CONFIG_PATH PYTHONHOME PYTHONPATH "${!ROS_@}"
    export ROS_LANG_DISABLE=genlisp:geneus:gennodejs # nobody here speaks these
    if [[ -d $noetic ]]; then
        set +u
        # shellcheck source=/dev/null
        . "$noetic/setup.bash"
        set -u
    fi
    cd "$root" || return
    rm -f src/compat/*/CATKIN_IGNORE
    (cd src/compat && compat_packages_of_system | xargs -I{} touch {}/CATKIN_IGNORE)
    export ROS_LANG_DISABLE=genlisp:geneus:gennodejs # bindings of the messages that nobody asks for
    # Without -j it would pass -l as well, and on a loaded machine make would wait for the load to sink.
    catkin_make -j"$(nproc)" -DPYTHON_EXECUTABLE="$root/.venv/bin/python3" -DCATKIN_ENABLE_TESTING=OFF
}

compat_packages_of_system() { # those of src/compat that the system has itself: they must not be shadowed
    local folder package
    for folder in "$root"/src/compat/*/; do
        package=$(basename "$folder")
        [[ ! -e $noetic/share/$package/package.xml && ! -e /usr/share/$package/package.xml ]] || say "$package"
    done
}

compile_kernels() {
    local log=$logs/kernels.log
    : >"$log"
    step "Compiling the numerical kernels" "$log" warm_kernels ||
        say "warning: that did not end well; each is compiled when it is first needed (see $log)"
    kernel_inputs >"$root/build/.kernels"
}

warm_kernels() {
    ros_environment
    python3 -m home_service.warm
}

give_up() { # SENTENCE LOG
    tail -n 20 "$2" | sed 's/^/  | /' >&2
    fail "$1 (see $2)"
}

main() {
    local extras=() option
    for option; do
        case $option in
            --dev) extras+=(dev) ;;
            --projects) extras+=(projects) ;;
            --rviz) extras+=(rviz) ;;
            --packages) packages_only=yes ;;
            --help | -h)
                usage
                exit 0
                ;;
            *)
                usage >&2
                printf "error: unknown option '%s'\n" "$option" >&2
                exit 2
                ;;
        esac
    done
    set_up "${extras[@]}"
    say "The workspace is set up${packages_only:+, but for the build}."
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then main "$@"; fi
