#!/usr/bin/env bash
# Usage: ./scripts/reproduce.sh RUN
#
# Runs again what has left the run folder RUN, with the same command, world, parameters and seed, and says
# whether it was the same to the last bit; if not, which message of which node differed first, and when.
# The new run is in RUN/again. What makes runs repeatable: docs/explanation/deterministic_runs.md.
# Exit code: 0 the same, 1 not the same, 2 bad input, 130 interrupted.
#
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command reproduce "$@"
