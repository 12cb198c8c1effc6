#!/usr/bin/env bash
# Usage: ./scripts/faults.sh [options]
#
# Plays the home-service mission in one process with each kind of fault, beside its clean twin of the same seed,
# and tells what became of it (docs/faults.md). Sets everything up first if need be.
# Exit code: 0 if no verdict was false and what can be survived was, 1 if not, 2 bad input, 130 interrupted.
#
#   --runs N         how many seeds, each with its clean twin (default: 1)
#   --kinds "A B"    only these kinds (default: all)
#   --start N        simulated seconds after which a fault begins (default: 8)
#   --write FILE     write the table as a page of the documentation
#   --mission FILE   carry out the deliveries of this file instead (docs/missions.md)
#   --zones FILE     YAML of the zones (default: map/zones.yaml)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       map of that world (default: map/home.yaml)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         the first seed (default: 0)
#   --timeout N      a run fails after N simulated seconds (default: 400)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command faults "$@"
