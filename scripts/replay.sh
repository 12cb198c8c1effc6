#!/usr/bin/env bash
# Usage: ./scripts/replay.sh [options] BAG...
#
# Replay bags (of recorded runs, or any with scans, odometry and /tf) to localization or mapping, without the recorded
# estimate, and measure the result against ground truth, if that was recorded.
# Bags are only read; a truncated one is replayed to its end, which the result states.
# Creates a run folder with report, trajectories (TUM) and result.json. BAG may be a folder of bags or a run folder.
# Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
#
#   --with amcl|slam|recorded
#                    localize in the map, make a map, or only show what was recorded (default: amcl)
#   --map FILE       for amcl: the map (default: map/home.yaml)
#   --start X Y YAW  for amcl: where the robot starts in the map (default: 0 0 0)
#   --save STEM      for slam: write STEM.pgm and STEM.yaml, not to the run folder
#   --rviz           show it in rviz, if there is a display
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --seed N         seed of all particles (default: 0)
#   --timeout N      the replay fails after N seconds of wall time (default: 900)
#   --gif            also leave run.gif, the run as an animation
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command replay "$@"
