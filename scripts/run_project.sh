#!/usr/bin/env bash
# Usage: ./scripts/run_project.sh PATH [SCRIPT] [options] [-- ARGUMENT...]
#
# Run an existing home-service project for the TurtleBot 2, Kinetic and Gazebo 7, unmodified and headless. PATH is its
# checkout (a workspace, the content of src, or one package), SCRIPT its shell script (default: home_service.sh).
# Works on a copy, with stand-ins for xterm, Gazebo and rviz; the checkout is only read.
# Prints goals and markers as they happen, then a verdict; result.json and a log of each window are in the run folder.
# Exit code: 0 all goals reached, 1 failure, 2 invalid input, 130 interrupted. More in docs/how_to/run_a_project.md.
#
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --seed N         seed of all noise (default: 0)
#   --timeout N      the run fails after N seconds of wall time (default: 600)
#   --expect LIST    expected ends of its goals, such as aborted,succeeded
#   --type WINDOW=TEXT...
#                    input for windows whose programs wait for it, such as add_markers=0
#   --rviz           show it in rviz with the project's configuration
#   --web            show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)
#   --web-port [ADDRESS:]PORT
#                    address of that page (default: a free port of 127.0.0.1); implies --web
#   --record         record a bag into the run folder
#   --build-only     stop after the build
#   --output FOLDER  folder in which the run folder is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
extras=(projects)
if is_among --rviz "$@"; then extras+=(rviz); fi
if is_asked_for_web "$@"; then extras+=(cockpit); fi
for word in "$@"; do
    if [[ -d $word ]] && grep -rqE --include=CMakeLists.txt 'OpenCV|cv_bridge' "$word"; then extras+=(opencv); fi
done
set_up "${extras[@]}"
enter_workspace
exec python3 -m run_project "$@"
