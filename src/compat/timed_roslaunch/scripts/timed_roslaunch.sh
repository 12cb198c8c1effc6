#!/usr/bin/env bash
# Launch a file of a package after a delay: timed_roslaunch.sh SECONDS PACKAGE FILE [ARGUMENT...]
if [[ $# -lt 3 ]]; then
  echo "usage: rosrun timed_roslaunch timed_roslaunch.sh SECONDS PACKAGE FILE [ARGUMENT...]" >&2
  exit 2
fi
arguments=()
for word in "${@:4}"; do
  [[ "$word" == __name:=* || "$word" == __log:=* ]] || arguments+=("$word") # roslaunch's, for this node
done
sleep "$1"
exec roslaunch "$2" "$3" "${arguments[@]}"
