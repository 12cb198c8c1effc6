#!/usr/bin/env bash
# Usage: ./scripts/new_plugin.sh NAME KIND [options]
#
# Lays out a catkin package in src/ with a class of your own that is found by its name, and its test.
# KIND: local_planner, global_planner, recovery_behavior, costmap_layer, sensor_model, motion_model, scan_matcher, fault
# or world_generator (docs/how_to/write_a_plugin.md).
# Sets everything up first if need be. Exit code: 0 success, 2 bad input, 130 interrupted.
#
#   --source FOLDER  where packages are (default: src)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command new_plugin "$@"
