#!/usr/bin/env bash
# Usage: ./scripts/launch.sh [options]
#
# Start the simulated home with the robot, until Ctrl-C. Performs the set-up if needed.
# Exit code: 0 ended by Ctrl-C, 1 failure or no result.json, 2 invalid input, 130 interrupted before it was ready.
#
#   --rviz           show it in rviz, if there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       show this map of the world with it (default: none)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         seed of all noise and particles (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and ground truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: never)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command launch "$@"
