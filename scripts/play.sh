#!/usr/bin/env bash
# Usage: ./scripts/play.sh SCENARIO [options]
#
# Plays one scenario with one seed, in one process, without ROS (docs/laboratory.md), and says how it went: one
# run out of the thousands of evaluate.sh, the same to the last bit. SCENARIO is a file, or a name in scenarios/.
# Sets everything up first if need be. Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --seed N         of all chance (default: 0)
#   --planner NAME   local planner (default: that of the scenario)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command play "$@"
