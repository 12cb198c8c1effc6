# shellcheck shell=bash disable=SC2154,SC2034 # variables of lib.sh and setup.sh
# The catkin build. Each has its folder, build/1, build/2 ...; the link devel points to the last good one.
# A build that fails or is interrupted changes nothing, and running programs keep the build they were started with.

build_inputs() { # two lines: digests of the list of packages and of the files that the build reads
    cd "$root" || return
    find -L src -name package.xml | sort | cat - <(print_line "$root" "$(readlink /usr/bin/python3)") <(ignored_packages) | sha256sum
    find -L src -mindepth 2 -type f \( -name package.xml -o -name CMakeLists.txt -o -name setup.py -o -path '*/nodes/*' \
        -o -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -name '*.cfg' \
        -o -name '*.c' -o -name '*.cpp' -o -name '*.h' -o -name '*.hpp' \) ! -path '*/__pycache__/*' -print0 |
        sort -z | xargs -0 sha256sum | sha256sum
}

build_workspace() {
    local log=$logs/build.log space
    inputs=$(build_inputs) # again: the packages that were just installed count
    (cd "$root" && check_names)
    : >"$log"
    choose_space
    if step "Building the workspace" "$log" catkin_build "$space"; then
        print_line "$inputs" >"$space/devel/.set-up"
        clear_projects
        take_into_use "$space"
        take_in_all
        remove_build_in_place
    else
        leave_out_invalid
        report_failure "$log"
        [[ -e $root/devel/.set-up ]] || fail "$failure"
    fi
    exec 8<&-
}

report_failure() { # LOG: sets failure; a failure caused by the sources is recorded, so that they are not built again
    failure=$(reason_in "$1")
    if [[ -z $failure ]]; then
        # Parallel jobs continue for a while after the one that fails.
        sed '/^make\[.*\*\*\* \[/q' "$1" | tail -n 20 | sed 's/^/  | /' >&2
        failure="$(fault_in "$1") (see $1)"
        printf '%s\n' "$inputs" "$failure" >"$root/build/.failed"
    fi
}

last_failure() { # its message, if these sources have failed to build while an earlier build is in use
    [[ -e $root/devel/.set-up && -e $root/build/.failed ]] || return 0
    [[ $(head -n 2 "$root/build/.failed") != "$inputs" ]] || tail -n +3 "$root/build/.failed"
}

# -- the folders of builds -----------------------------------------------------------------------------

clear_projects() { # projects of users, built on top of the last build; a running one holds the lock in its folder
    local folder
    for folder in "$root"/build/projects/*/; do
        [[ ! -d $folder ]] || flock --nonblock "$folder/lock" rm -rf "$folder" ||
            print_line "left alone, in use: $folder"
    done
}

choose_space() { # sets space: the first folder that no program uses; locked during the build
    local number=1
    until space=$root/build/$number && is_free "$space"; do ((number += 1)); done
    # A build that was made elsewhere, contains removed packages or was interrupted is made again.
    if [[ $(head -n 1 "$space/devel/.set-up" 2>/dev/null) == "${inputs%%$'\n'*}" ]]; then
        rm "$space/devel/.set-up"
    else
        rm -rf "$space/build" "$space/devel"
    fi
}

is_free() { # SPACE
    [[ $(readlink -f "$root/devel") != "$1/devel" ]] && mkdir -p "$1" && exec 8<"$1" && flock --nonblock 8
}

take_into_use() { # SPACE
    rm -rf "$root/devel.new"
    ln -s "build/${1##*/}/devel" "$root/devel.new"
    if [[ -d $root/devel && ! -L $root/devel ]]; then # built by version 1.0.0
        exchange "$root/devel" "$root/devel.new"
        rm -rf "$root/devel.new"
    else
        mv -T "$root/devel.new" "$root/devel"
    fi
}

remove_build_in_place() { # of version 1.0.0, in build/ itself
    [[ -e $root/build/CMakeCache.txt ]] || return 0
    find "$root/build" -mindepth 1 -maxdepth 1 ! -name '[0-9]*' ! -name projects ! -name .kernels ! -name CMakeCache.txt \
        -exec rm -rf {} +
    rm "$root/build/CMakeCache.txt"
}

leave_out_invalid() { # ROS's tools read each package in the source space and stop at the first invalid one
    [[ -e $root/devel/.catkin ]] || return 0
    local valid
    valid=$(/usr/bin/python3 -c '
import os, sys
from catkin_pkg.package import InvalidPackage, parse_package
from catkin_pkg.packages import find_package_paths

valid = []
for path in sorted(find_package_paths(sys.argv[1])):
    folder = os.path.join(sys.argv[1], path)
    try:
        parse_package(folder)
        valid.append(folder)
    except (InvalidPackage, UnicodeDecodeError):
        pass
print(";".join(valid))' "$root/src") && write_source_space "$valid"
}

take_in_all() { # after the faulty package was removed or corrected
    [[ -e $root/build/.failed && -w $root/build ]] || return 0
    [[ ! -e $root/devel/.catkin ]] || write_source_space "$root/src"
    rm "$root/build/.failed"
}

write_source_space() { # FOLDERS, as catkin has it: separated by semicolons
    printf %s "$1" >"$root/devel/.catkin.new" && mv "$root/devel/.catkin.new" "$root/devel/.catkin"
}

# -- catkin --------------------------------------------------------------------------------------------

catkin_build() { # SPACE
    # A sourced workspace must not become an underlay of this one.
    unset CMAKE_PREFIX_PATH LD_LIBRARY_PATH PKG_CONFIG_PATH PYTHONHOME PYTHONPATH "${!ROS_@}"
    if [[ -d $noetic ]]; then
        set +u
        # shellcheck source=/dev/null
        . "$noetic/setup.bash"
        set -u
    fi
    # pip installs into .venv meanwhile: Debian's packages must precede those that are installed in part.
    export PYTHONPATH=${PYTHONPATH:+$PYTHONPATH:}/usr/lib/python3/dist-packages
    cd "$root" || return
    mark_ignored_packages
    export ROS_LANG_DISABLE=genlisp:geneus:gennodejs # unused message bindings
    # Without -j catkin_make would pass -l as well, and make would wait on a loaded machine.
    # The Python of nodes is set by three variables: catkin of Debian 13 reads only the second, pluginlib the third.
    # Only cmake detects a new message in a folder.
    catkin_make --force-cmake -j"$(nproc)" -D{PYTHON,Python,Python3}_EXECUTABLE="$root/.venv/bin/python3" \
        -DCATKIN_ENABLE_TESTING=OFF --build "$1/build" -DCATKIN_DEVEL_PREFIX="$1/devel"
}

mark_ignored_packages() { # running programs may search packages meanwhile: unchanged marks are not touched
    local ignored folder
    ignored=$(ignored_packages)
    for folder in src/compat/*/ src/tutorials/*/; do
        grep -qxF "${folder%/}" <<<"$ignored" || rm -f "$folder/CATKIN_IGNORE"
    done
    [[ -z $ignored ]] || xargs -I{} touch {}/CATKIN_IGNORE <<<"$ignored"
}

# Packages in these folders give way to packages of the same name of the system or the user.
readonly giving_way='src/(compat|tutorials)/'

ignored_packages() { # folders
    local packages name folder
    local -A is_of_user=()
    packages=$(packages_in_source)
    while read -r name folder; do is_of_user[_$name]=yes; done < <(of_user <<<"$packages")
    while read -r name folder; do
        if is_of_system "$name" && [[ $folder == src/compat/* ]] || [[ -n ${is_of_user[_$name]:-} ]]; then
            print_line "$folder"
        fi
    done < <(grep -E " ${giving_way}[^/]+\$" <<<"$packages")
}

packages_in_source() { # NAME FOLDER, one package a line
    find -L src -name package.xml -exec awk '
        FNR == 1 { is_found = 0 }
        !is_found && match($0, /<name>[^<]+/) {
            is_found = 1
            name = substr($0, RSTART + 6, RLENGTH - 6)
            gsub(/[ \t]/, "", name)
            folder = FILENAME
            sub(/\/package\.xml$/, "", folder)
            print name, folder
        }' {} + | sort
}

of_user() { grep -vE " $giving_way" || true; }

is_of_system() { [[ -e $noetic/share/$1/package.xml || -e /usr/share/$1/package.xml ]]; } # NAME

check_names() { # catkin builds nothing where two packages have one name
    local packages name
    packages=$(packages_in_source)
    name=$(of_user <<<"$packages" | cut -d' ' -f1 | uniq --repeated | head -n 1)
    [[ -z $name ]] || fail "two packages are named '$name' ($(sed -n "s/^$name //p" <<<"$packages" |
        paste -sd' ' | sed 's/ / and /g')): rename or remove one"
    while read -r name; do
        name=${name##*/}
        ! of_user <<<"$packages" | grep -q "^$name " || print_line "your package '$name' takes the place of the project's own"
    done < <(ignored_packages)
}

fault_in() { # LOG: the package that does not build, and its missing dependency
    local package lacks remedy="./scripts/setup.sh --projects installs what most packages in C++ need"
    package=$(without_warnings "$1" | sed -nE "s/^Error\(s\) in package '(.*)\/package.xml':.*/\1/p
        s/^(CMake Error at | +)([^/ ][^ :]*)\/CMakeLists\.txt:[0-9]+ \(.*/\2/p
        s/^make\[[0-9]+\]: \*\*\* \[([^ ]*)\/CMakeFiles\/.*/\1/p" | head -n 1)
    lacks=$(sed -nE 's/.*Could not find a package configuration file provided by "([^"]*)".*/\1/p' "$1" | head -n 1)
    if [[ -z $package ]]; then
        print_line "the catkin build failed"
    else
        lacks=${lacks:+: it needs $lacks, which is not installed ($remedy)}
        print_line "the package '$(basename "$package")' does not build$lacks"
    fi
}

without_warnings() { # LOG; warnings name the files that led to them, as errors do
    awk '/^CMake .*Warning/ { warns = 1 } /^(CMake Error|make|Error)/ { warns = 0 } !warns' "$1"
}

# -- the numerical kernels -----------------------------------------------------------------------------

# Files with kernels, and with classes that are arguments of kernels.
kernel_inputs() { (cd "$root" && { grep -rlE --include='*.py' 'numba|NamedTuple' src || true; } | sort | xargs -r stat -c '%n %Y %s' | sha256sum); }

warm_kernels() { of_workspace home_service.kernel_cache "$root" && of_workspace home_service.warm; }

of_workspace() { # MODULE ARGUMENT...: run a module of the packages in src/
    env -u PYTHONHOME PYTHONPATH="$(printf '%s:' "$root"/src/*/src)" "$root/.venv/bin/python3" -m "$@"
}
