#!/usr/bin/env bash
# Usage: ./scripts/test_slam.sh [options]
#
# Start home and SLAM, with the robot driven by keys of the terminal or of a pipe, such as
#   echo i:2.0 j:1.5 | ./scripts/test_slam.sh
# on a page in the browser, or autonomously. Saves the map at the end. Performs the set-up if needed.
# Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
#
#   --drive WHO      keys; page: in the browser, until Ctrl-C, --web is implied; auto: the robot explores autonomously
#                    (default: keys)
#   --save STEM      write STEM.pgm and STEM.yaml (default: map in the run folder)
#   --rviz           show it in rviz, if there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up
#                    (default: 1; with --drive auto and no view 0)
#   --world FILE     SDF world (default: map/home.world)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         seed of all noise (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and ground truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: 900, with keys never)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command test_slam "$@"
