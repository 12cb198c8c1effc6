#!/usr/bin/env bash
# Usage: ./scripts/test_slam.sh [options]
#
# Starts home and SLAM; the robot is driven with the keys of the terminal or of a pipe, such as
#   echo i:2.0 j:1.5 | ./scripts/test_slam.sh
# at the page in the browser, or by itself. Saves the map at the end. Sets everything up first if need be.
# Exit code: 0 success, 1 failure or no result.json, 2 bad input, 130 interrupted.
#
#   --drive WHO      keys; page: in the browser, until Ctrl-C, --web is implied; auto: the robot explores by itself
#                    (default: keys)
#   --save STEM      write STEM.pgm and STEM.yaml (default: map in the run folder)
#   --rviz           show it in rviz, where there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    where that page is served (default: a free port of 127.0.0.1); --web is implied
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up
#                    (default: 1; with --drive auto and no view 0)
#   --world FILE     SDF world (default: map/home.world)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         seed of every noise (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: 900, with keys never)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  where the run folder is made (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command test_slam "$@"
