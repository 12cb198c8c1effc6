#!/usr/bin/env bash
# Usage: ./scripts/evaluate.sh SUITE... [options]
#
# Plays scenarios (docs/reference/scenarios.md) with many seeds over all cores, without ROS, and says what that proves:
# success with its interval, times, collisions, clearance. SUITE is a file of a scenario, a folder of them, or a
# name in scenarios/. Each result is kept at once; what has been played with the same software is not played
# again, so that Ctrl-C loses nothing. Sets everything up first if need be, with Dask and statsmodels.
# Exit code: 0 success, 1 a rule does not hold, 2 bad input (the rest is played), 130 interrupted.
#
#   --seeds SEEDS      like 0-999 or 1,5,7 (default: those of the scenario)
#   --planner NAME...  with each of these local planners (default: the scenario's); over ROS also official, which
#                      is the official move_base with its DWA
#   --workers N        processes (default: one for each core)
#   --scheduler ADDRESS  Dask's, instead of processes here: tcp://HOST:8786
#   --require RULE...  exit code 1 unless this holds of each scenario: "success >= 0.99"
#   --against VERSION  exit code 1 if a scenario is worse than with this version of the software, on the same seeds
#   --over WHAT        what plays each: process, or ros, the graph of nodes, a few runs a minute (default: process)
#   --output FOLDER    results are kept and told here (default: runs/laboratory)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command evaluate "$@"
