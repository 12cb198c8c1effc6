#!/usr/bin/env bash
# Usage: ./scripts/map_home.sh [options]
#
# Explore a world with SLAM, return, save the map, and score it against the true one.
# Performs the set-up if needed. Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
#
#   --save STEM      write STEM.pgm and STEM.yaml (default: map in the run folder)
#   --rviz           show it in rviz, if there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --world FILE     SDF world (default: map/home.world)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         seed of all noise (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and ground truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: 900)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command map_home "$@"
