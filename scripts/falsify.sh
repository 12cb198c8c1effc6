#!/usr/bin/env bash
# Usage: ./scripts/falsify.sh SCENARIO [options]
#
# Search for a failure in a scenario (docs/reference/scenarios.md): places of boxes, pedestrians and their goals, faults,
# noise, seeds, each case near the hardest so far. The first failing case is reduced to a minimal one and written as
# a scenario. Ctrl-C loses nothing; the next start continues. Performs the set-up if needed, with Optuna and Dask.
# Exit code: 0 nothing found, 1 a failure found, 2 invalid input, 130 interrupted.
#
#   --trials N         maximum number of cases (default: 200)
#   --boxes N          maximum number of boxes (default: 4)
#   --people N         maximum number of pedestrians (default: 2)
#   --faults N         maximum number of faults (default: 1)
#   --seed N           seed of the search (default: 0)
#   --planner NAME     local planner (default: that of the scenario)
#   --workers N        number of processes (default: one for each core)
#   --scheduler ADDRESS  Dask scheduler instead of local processes: tcp://HOST:8786
#   --output FOLDER    folder of results (default: runs/falsify)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command falsify "$@"
