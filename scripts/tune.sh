#!/usr/bin/env bash
# Usage: ./scripts/tune.sh SUITE... --prove SUITE... [options]
#
# Search parameters of move_base with which scenarios take less time and fail less (docs/reference/scenarios.md), with
# Optuna, and prove the gain on other suites by exact tests on the same seeds. The best are written to tuned.yaml.
# Ctrl-C loses nothing; the next start continues with the same result. Performs the set-up if needed.
# Exit code: 0 a gain is proved, 1 none is, 2 invalid input, 130 interrupted.
#
#   --prove SUITE...   suites on which the gain is proved (required)
#   --space FILE       parameters and their bounds (default: scenarios/tuning/mppi.yaml)
#   --trials N         number of candidates (default: 64)
#   --seeds SEEDS      of the search (default: 0-9)
#   --proof-seeds SEEDS  of the proof (default: 1000-1099)
#   --seed N           seed of the search (default: 0)
#   --workers N        number of processes (default: one for each core)
#   --scheduler ADDRESS  Dask scheduler instead of local processes: tcp://HOST:8786
#   --output FOLDER    folder of results (default: runs/tune)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command tune "$@"
