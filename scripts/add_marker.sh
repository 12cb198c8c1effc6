#!/usr/bin/env bash
# Usage: ./scripts/add_marker.sh [options]
#
# Shows the object at pick-up, hides it, and shows it at drop-off, by the clock. Sets everything up first if need be.
# Exit code: 0 success, 1 failure or no result.json, 2 bad input, 130 interrupted.
#
#   --zones FILE     YAML of the zones (default: map/zones.yaml)
#   --rviz           show it in rviz, where there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    where that page is served (default: a free port of 127.0.0.1); --web is implied
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --world FILE     SDF world (default: map/home.world)
#   --map FILE       map of that world (default: map/home.yaml)
#   --robot NAME     robot profile of sim_bridge (default: turtlebot_lidar)
#   --seed N         seed of every noise and every particle (default: 0)
#   --record inputs|all
#                    record bags: scans, odometry and truth, or everything (docs/how_to/record_and_replay.md)
#   --timeout N      the run fails after N seconds of wall time (default: 900)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  where the run folder is made (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command add_marker "$@"
