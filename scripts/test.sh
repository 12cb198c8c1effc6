#!/usr/bin/env bash
# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
if is_among --quick "$@"; then set_up; else set_up "${development[@]}"; fi
enter_workspace
exec python3 "$root/tests/runner/run_tests.py" "$@"
