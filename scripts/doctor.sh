#!/usr/bin/env bash
# Usage: ./scripts/doctor.sh [options]
#
# Print what is running, what each node waits for, the chain of frames, rates, clock, versions, and problems.
# Inspects the graph of ROS_MASTER_URI or, without a master there, the newest one on this machine.
# Exit code: 0 healthy, 1 problems, 2 invalid input, 3 nothing is running.
#
#   --json           print JSON
#   --master URI     master of the graph, if there are several
#   --seconds N      duration of the measurement of rates (default: 2)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command doctor "$@"
