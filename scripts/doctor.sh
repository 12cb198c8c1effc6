#!/usr/bin/env bash
# Usage: ./scripts/doctor.sh [options]
#
# Says what is running, what each node waits for, the chain of frames, rates, clock, versions, and what is wrong.
# It looks at the graph of ROS_MASTER_URI or, if nobody answers there, at the newest one on this machine.
# Exit code: 0 healthy, 1 something is wrong, 2 bad input, 3 nothing is running.
#
#   --json           print for programs
#   --master URI     the graph to look at, if there are several
#   --seconds N      how long rates are measured (default: 2)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command doctor "$@"
