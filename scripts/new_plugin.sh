#!/usr/bin/env bash
# Usage: ./scripts/new_plugin.sh NAME KIND [options]
#
# Create a catkin package in src/ with a plugin class and its test.
# KIND: local_planner, global_planner, recovery_behavior, costmap_layer, sensor_model, motion_model, scan_matcher, fault
# or world_generator (docs/how_to/write_a_plugin.md).
# Performs the set-up if needed. Exit code: 0 success, 2 invalid input, 130 interrupted.
#
#   --source FOLDER  folder of the package (default: src)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command new_plugin "$@"
