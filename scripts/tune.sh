#!/usr/bin/env bash
# Usage: ./scripts/tune.sh SUITE... --prove SUITE... [options]
#
# Looks for parameters of move_base with which scenarios take less time and fail less (docs/reference/scenarios.md), by
# Optuna, and proves the gain on other suites by exact tests on the same seeds. The best go into tuned.yaml.
# Ctrl-C loses nothing; the next start goes on, and comes to the same. Sets everything up first if need be.
# Exit code: 0 a gain is proved, 1 none is, 2 bad input, 130 interrupted.
#
#   --prove SUITE...   suites on which the gain is to be proved (needed)
#   --space FILE       parameters and their bounds (default: scenarios/tuning/mppi.yaml)
#   --trials N         candidates that are tried (default: 64)
#   --seeds SEEDS      that candidates are tried on (default: 0-9)
#   --proof-seeds SEEDS  that the gain is proved on (default: 1000-1099)
#   --seed N           of the search (default: 0)
#   --workers N        processes (default: one for each core)
#   --scheduler ADDRESS  Dask's, instead of processes here: tcp://HOST:8786
#   --output FOLDER    what is found is kept here (default: runs/tune)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command tune "$@"
