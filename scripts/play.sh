#!/usr/bin/env bash
# Usage: ./scripts/play.sh SCENARIO [options]
#
# Plays one scenario with one seed (docs/reference/scenarios.md), in one process, without ROS, and says how it went: one
# run out of the thousands of evaluate.sh, the same to the last bit. SCENARIO is a file, or a name in scenarios/.
# With --over ros the graph of nodes plays it, as home_service.sh its mission, and leaves a run folder.
# Sets everything up first if need be. Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --seed N         of all chance (default: 0)
#   --planner NAME   local planner (default: that of the scenario); over ROS also official: the official move_base
#   --over WHAT      what plays it: process, or ros (default: process)
#   --help           this text
#
# Only with --over ros:
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --rviz, --web    show the run in rviz, or in the browser; --web-port [ADDRESS:]PORT
#   --gif            also leave run.gif
#   --timeout S      wall-clock seconds it may take (default: 900)
#   --output FOLDER  where run folders are made (default: runs)

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command play "$@"
