#!/usr/bin/env bash
# Usage: ./scripts/rehearse.sh [options]
#
# Run the home-service mission in one process, without ROS: the same simulation, localization, navigation and mission
# as in the nodes, many times faster than real time, and repeatable bit for bit for a seed.
# Performs the set-up if needed, prints a line for each run and a verdict.
# Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
#
#   --runs N         number of runs, each with the next seed (default: 1)
#   --mission FILE   run the deliveries of this file instead (docs/reference/missions.md)
#   --faults FILE    YAML with a list of faults (docs/reference/faults.md; default: that of the mission)
#   --each-fault FILE   compare each kind of fault with a run without it instead; writes a report to FILE
#   --zones FILE     YAML of the zones (default: map/zones.yaml)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       map of that world (default: map/home.yaml)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --planner NAME   local planner: official or my_package.my_module/MyPlanner
#   --seed N         seed of all noise and particles (default: 0)
#   --timeout N      a run fails after N simulated seconds (default: 600)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command rehearse "$@"
