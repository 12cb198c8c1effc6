#!/usr/bin/env bash
# Usage: ./scripts/report.sh RUN [options]
#
# Makes the report of a run anew, from what its folder holds: report.html, run.png, the trajectories.
# Sets everything up first if need be. Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --gif            also make run.gif, the run as an animation
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command report "$@"
