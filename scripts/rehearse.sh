#!/usr/bin/env bash
# Usage: ./scripts/rehearse.sh [options]
#
# Plays the home-service mission in one process, without ROS: the same simulation, localization, navigation
# and errand as in the nodes, many times faster than real time, and the same to the last bit for a seed.
# Sets everything up first if need be, prints a line for each run and a verdict.
# Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --runs N         how many runs, each with the next seed (default: 1)
#   --mission FILE   carry out the deliveries of this file instead (docs/reference/missions.md)
#   --faults FILE    YAML with a list of what goes wrong (docs/reference/faults.md; default: that of the mission)
#   --each-fault FILE   with each kind of fault beside a clean twin instead; writes the table to this page
#   --zones FILE     YAML of the zones (default: map/zones.yaml)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       map of that world (default: map/home.yaml)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --planner NAME   local planner: official or my_package.my_module/MyPlanner
#   --seed N         seed of every noise and every particle (default: 0)
#   --timeout N      a run fails after N simulated seconds (default: 600)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command rehearse "$@"
