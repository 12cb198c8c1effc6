#!/usr/bin/env bash
# Usage: ./scripts/home_service.sh [options]
#
# Fetch the object at the pick-up zone and deliver it at the drop-off zone in the simulated home, or run another mission.
# Performs the set-up if needed, prints the run folder with logs and result.json, and a verdict.
# Exit code: 0 success, and Ctrl-C with --serve; 1 failure or no result.json, 2 invalid input, 130 interrupted.
#
#   --mission FILE   run the deliveries of this file instead (docs/reference/missions.md; map/mission.yaml is one)
#   --serve          wait for missions sent to the action deliver, until Ctrl-C
#   --faults FILE    YAML with a list of faults (docs/reference/faults.md; default: that of the mission)
#   --zones FILE     YAML of the zones (default: map/zones.yaml)
#   --marker-source tf|amcl_pose|odom|state
#                    source of the robot pose for the marker (default: tf)
#   --rviz           show it in rviz, if there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       map of that world (default: map/home.yaml)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --planner NAME   local planner: official or my_package.my_module/MyPlanner
#   --seed N         seed of all noise and particles (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and ground truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: 900, with --serve never)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command home_service "$@"
