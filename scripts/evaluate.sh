#!/usr/bin/env bash
# Usage: ./scripts/evaluate.sh SUITE... [options]
#
# Run scenarios (docs/reference/scenarios.md) with many seeds on all cores, without ROS, and print success rates with
# intervals, times, collisions and clearance. SUITE is a scenario file, a folder of them, or a name in scenarios/.
# Each result is stored at once; results of the same software are not computed again, so Ctrl-C loses nothing.
# Performs the set-up if needed, with Dask and statsmodels.
# Exit code: 0 success, 1 a rule is violated, 2 invalid input (the rest is run), 130 interrupted.
#
#   --seeds SEEDS      such as 0-999 or 1,5,7 (default: those of the scenario)
#   --planner NAME...  run with each of these local planners (default: that of the scenario); over ROS also official,
#                      the official move_base with DWA
#   --workers N        number of processes (default: one for each core)
#   --scheduler ADDRESS  Dask scheduler instead of local processes: tcp://HOST:8786
#   --require RULE...  exit code 1 unless this holds for each scenario: "success >= 0.99"
#   --against VERSION  exit code 1 if a scenario is worse than with this version of the software, on the same seeds
#   --over WHAT        how each is run: process, or ros, the graph of nodes, a few runs a minute (default: process)
#   --output FOLDER    folder of results (default: runs/laboratory)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command evaluate "$@"
