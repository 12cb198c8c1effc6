#!/usr/bin/env bash
# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
extras=(projects)
if is_among --rviz "$@"; then extras+=(rviz); fi
if is_asked_for_web "$@"; then extras+=(cockpit); fi
for word in "$@"; do
    if [[ -d $word ]] && grep -rqE --include=CMakeLists.txt 'OpenCV|cv_bridge' "$word"; then extras+=(opencv); fi
done
set_up "${extras[@]}"
enter_workspace
exec python3 -m run_project "$@"
