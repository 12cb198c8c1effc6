#!/usr/bin/env bash
# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
folders=()
for word in "$@"; do
    [[ ! -d $word ]] || folders+=("$word")
done
((${#folders[@]})) || folders=(.)
has() { grep -rqE --include="$1" "$2" "${folders[@]}"; } # FILES PATTERN
extras=()
# A project in Python is built without the libraries for C++.
if has CMakeLists.txt '^[^#]*(add_executable|add_library|generate_messages)' || has '*.launch' joint_state_publisher; then
    extras+=(projects)
fi
if has CMakeLists.txt 'OpenCV|cv_bridge'; then extras+=(opencv); fi
if is_among --rviz "$@"; then extras+=(rviz); fi
if is_asked_for_web "$@"; then extras+=(cockpit); fi
set_up "${extras[@]}"
enter_workspace
exec python3 -m run_project "$@"
