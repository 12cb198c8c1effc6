#!/usr/bin/env bash
# Usage: ./scripts/fuzz.sh [options]
#
# Gives every reader of files thousands of broken ones, and keeps those that it does not refuse in words, or not
# within 5 s and 1 GB (docs/how_to/fuzz.md). Sets everything up first if need be, with Atheris.
# Exit code: 0 nothing was found, 1 something was, 2 bad input, 130 interrupted.
#
#   --minutes MINUTES  for all readers together (default: 5)
#   --cases CASES      for each reader, if there is the time (default: no end)
#   --reader NAME...   only of these, like world or map_image (default: all)
#   --seed SEED        of all chance (default: 0)
#   --output OUTPUT    what is found is kept here (default: build/fuzz)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
set_up fuzzing
enter_workspace
exec python3 "$root/tests/fuzz/hunt.py" "$@"
