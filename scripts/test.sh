#!/usr/bin/env bash
# Usage: ./scripts/test.sh [unit|ros|all] [NAME...] [--quick] [--jobs N]
#
# Run the tests: unit tests (pytest, no ROS), ROS tests (rostest: nodes and whole missions), or both, the default; with
# NAMEs only the test files whose paths contain one. Performs the set-up if needed, with all that the tests need, as
# ./scripts/setup.sh --dev does.
# Logs and JUnit reports: logs/tests/. Exit code: 0 all passed, 1 failure, 2 invalid usage, 130 interrupted.
#
#   --quick    without that: tests of what only ./scripts/setup.sh --dev installs (a browser, Dask ...) are skipped
#              if it is not there
#   --jobs N   number of ROS test files run at the same time (default: one for each core, at most 4)
#   --help     this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
if is_among --quick "$@"; then set_up; else set_up "${development[@]}"; fi
enter_workspace
export ROS_PACKAGE_PATH="$root/tests:$ROS_PACKAGE_PATH"
export PYTHONPATH="$root/tests/shared:$PYTHONPATH"
exec python3 "$root/tests/runner/run_tests.py" "$@"
