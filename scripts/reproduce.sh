#!/usr/bin/env bash
# Usage: ./scripts/reproduce.sh RUN
#
# Run the command of a run folder again, with the same world, parameters and seed, and compare every bit; print the
# first message that differs, with its node and time. The new run is in RUN/again.
# What makes runs repeatable: docs/explanation/deterministic_runs.md.
# Exit code: 0 the same, 1 not the same, 2 invalid input, 130 interrupted.
#
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command reproduce "$@"
