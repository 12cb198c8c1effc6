#!/usr/bin/env bash
# Usage: ./scripts/setup.sh [--dev] [--projects] [--rviz] [--web] [--laboratory] [--gymnasium] [--service]
#        [--drawings] [--packages]
#
# Install what the workspace lacks: Debian packages (as root or with sudo), Python packages in .venv, the catkin build in
# build/ and devel/. The other scripts do this when they start. Does nothing if everything is up to date, and continues
# an interrupted set-up. Logs: logs/setup/. If a package in src/ does not build, the last successful build stays in use.
#
#   --dev        also for the checks in .ci/run and the benchmarks: ruff, mypy, chromium, the extras ...
#   --projects   also for run_project.sh: libraries for projects in C++
#   --rviz       also rviz
#   --web        also the cockpit in the browser
#   --laboratory also for evaluate.sh: Dask, statsmodels, pyarrow, Optuna
#   --gymnasium  also for the environments: gymnasium
#   --service    also for service.sh: FastAPI, uvicorn, croniter
#   --drawings   also for DXF and IFC files in build_home.sh: ezdxf, ifcopenshell
#   --packages   only the Debian and Python packages, for example for a cached layer of an image
#   --help       this text

scripts=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
# shellcheck source=scripts/lib.sh
. "$scripts/lib.sh"
# shellcheck source=scripts/setup/system.sh
. "$scripts/setup/system.sh"
# shellcheck source=scripts/setup/debian.sh
. "$scripts/setup/debian.sh"
# shellcheck source=scripts/setup/python.sh
. "$scripts/setup/python.sh"
# shellcheck source=scripts/setup/workspace.sh
. "$scripts/setup/workspace.sh"

readonly logs=$root/logs/setup
readonly development=(dev cockpit laboratory gymnasium service fuzzing drawings) # the extras that all tests need
packages_only=
failure=
outdated= # parts that stay in use although their sources have changed
retry= # also build sources that have failed before

set_up() { # EXTRA...: brings the workspace up to date; extras: dev, projects, opencv, rviz, cockpit, laboratory, gymnasium, service, fuzzing, drawings
    look_for_missing "$@"
    if [[ -n $packages$requirements$build$kernels ]]; then
        check_place
        mkdir -p "$logs"
        take_turns
        restore_venv
        look_for_missing "$@"
        announce
        start_python
        [[ -z $packages ]] || install_debian
        [[ -z $build ]] || build_workspace
        finish_python
        exec 9<&- # the program that starts now must not hold the lock of the set-up
    fi
    if [[ -n $failure ]]; then warn_of_failure; else take_in_all; fi
    [[ -z $outdated ]] ||
        printf 'warning: what runs in this workspace keeps its %s; new ones come with the next start\n' "$outdated" >&2
}

look_for_missing() { # EXTRA...: each of the variables is empty when nothing of its kind is missing
    requirement_files=(requirements.txt)
    local extra
    for extra; do
        [[ ! -e $root/scripts/requirements-$extra.txt ]] || requirement_files+=("requirements-$extra.txt")
    done
    requirements=$(cd "$root/scripts" && missing_requirements "${requirement_files[@]}")
    inputs=$([[ ! -d $root/src ]] || build_inputs) # an image is given the packages before the sources
    failure=
    [[ -n $retry ]] || failure=$(last_failure)
    build=
    [[ -n $failure ]] || has_stamp "$root/devel/.set-up" "$inputs" || build=workspace
    outdated=
    [[ -n $retry ]] || ! is_inside || keep_what_runs
    kernels=
    [[ -z $build ]] && has_stamp "$root/build/.kernels" "$(kernel_inputs)" || kernels=kernels
    packages=$(cd "$root/scripts" && missing_packages "$@" ${build:+build})
    [[ -z $packages_only ]] || build='' kernels=''
}

keep_what_runs() { # a script started by a running program uses the build and packages of that program
    [[ -z $build ]] || outdated=build build=''
    ! replaces_packages || outdated=${outdated:+$outdated and }"Python packages" requirements=''
}

has_stamp() { [[ -e $1 && $(<"$1") == "$2" ]]; } # FILE TEXT

announce() {
    print_line "Setting up the workspace in $root (once; logs in logs/setup/):"
    [[ -z $packages ]] || print_line "  Debian packages, with apt-get: ${packages//$'\n'/ }"
    [[ -z $requirements ]] || print_line "  Python packages, into .venv: $(requirement_names)"
    [[ -z $build ]] || print_line "  catkin build, into build/ and devel/"
    [[ -z $kernels ]] || print_line "  compiled numerical kernels, into __pycache__ folders of src/"
}

start_python() { # in the background: it needs neither Debian's packages nor the build
    [[ -z $requirements ]] || prepare_python
    [[ -z $requirements$kernels ]] || start_aside "$logs/python.log" install_python
}

install_debian() {
    local names
    mapfile -t names <<<"$packages"
    install_packages "${names[@]}"
}

prepare_python() {
    local needed
    [[ $packages != *python3-venv* ]] || install_packages python3-venv
    if [[ -n $(missing_wheel) ]]; then
        print_line "PyBullet has no wheel for this machine: it is compiled once, in about 3 minutes on two cores, into $wheels"
        mapfile -t needed < <(cd "$root/scripts" && missing_in apt-packages-wheel.txt)
        ((${#needed[@]} == 0)) || { check_root "${needed[*]}" && install_packages "${needed[@]}"; }
    fi
    make_venv
}

readonly not_fetched=3 not_installed=4 not_compiled=5

install_python() { # the exit code states which part failed
    if [[ -n $requirements ]]; then
        fetch_requirements || return "$not_fetched"
        install_requirements || return "$not_installed"
    fi
    [[ -z $kernels ]] || warm_kernels >"$logs/kernels.log" 2>&1 || return "$not_compiled"
}

finish_python() {
    [[ -z $aside_pid ]] || end_python
    shield_rospy
    [[ -z $kernels ]] || kernel_inputs >"$root/build/.kernels"
}

end_python() {
    local title="Python packages" log=$logs/python.log status=0
    [[ -z $kernels ]] || title=${requirements:+$title, }"Numerical kernels"
    finish_aside "$title" || status=$?
    case $status in
        0) ;;
        "$not_fetched") give_up "the Python packages could not be fetched" "$log" ;;
        "$not_compiled")
            print_line "warning: the kernels were not compiled; each is when it is first needed (see $logs/kernels.log)"
            ;;
        *) give_up "pip failed" "$log" ;;
    esac
}

warn_of_failure() {
    [[ -z $retry ]] || fail "$failure: the workspace stays as it was built before"
    printf 'warning: %s: the workspace is used as it was built before\n' "$failure" >&2
}

main() {
    local extras=() option
    retry=yes
    for option; do
        case $option in
            --dev) extras+=("${development[@]}") ;;
            --projects) extras+=(projects) ;;
            --rviz) extras+=(rviz) ;;
            --web) extras+=(cockpit) ;;
            --laboratory) extras+=(laboratory) ;;
            --gymnasium) extras+=(gymnasium) ;;
            --service) extras+=(service) ;;
            --drawings) extras+=(drawings) ;;
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
    print_line "The workspace is set up${packages_only:+, but for the build}."
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then main "$@"; fi
