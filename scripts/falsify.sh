#!/usr/bin/env bash
# Usage: ./scripts/falsify.sh SCENARIO [options]
#
# Searches for what breaks the robot in a scenario (docs/reference/scenarios.md): places of boxes, people and their ways,
# faults, noise, seeds, each case near to the hardest so far. The first that fails is shrunk to the least that
# still fails, and written as a scenario of its own. Ctrl-C loses nothing; the next start goes on. Sets
# everything up first if need be, with Optuna and Dask.
# Exit code: 0 nothing found, 1 a failure found, 2 bad input, 130 interrupted.
#
#   --trials N         cases that are tried at most (default: 200)
#   --boxes N          boxes at most (default: 4)
#   --people N         people at most (default: 2)
#   --faults N         faults at most (default: 1)
#   --seed N           of the search (default: 0)
#   --planner NAME     local planner (default: that of the scenario)
#   --workers N        processes (default: one for each core)
#   --scheduler ADDRESS  Dask's, instead of processes here: tcp://HOST:8786
#   --output FOLDER    what is found is kept here (default: runs/falsify)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command falsify "$@"
