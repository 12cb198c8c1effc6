#!/usr/bin/env bash
# Usage: ./scripts/report.sh RUN [options]
#
# Make the report of a run again from its folder: report.html, run.png, the trajectories.
# Performs the set-up if needed. Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
#
#   --gif            also make run.gif, the run as an animation
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command report "$@"
