#!/usr/bin/env bash
# Usage: ./scripts/fuzz.sh [options]
#
# Give every reader of files thousands of malformed ones, and store those that it does not refuse with an error
# message within 5 s and 1 GB (docs/how_to/fuzz.md). Performs the set-up if needed, with Atheris.
# Exit code: 0 nothing found, 1 failures found, 2 invalid input, 130 interrupted.
#
#   --minutes MINUTES  for all readers together (default: 5)
#   --cases CASES      maximum number of files for each reader (default: unlimited)
#   --reader NAME...   only these, such as world or map_image (default: all)
#   --seed SEED        seed (default: 0)
#   --output OUTPUT    folder of results (default: build/fuzz)
#   --help             this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
set_up fuzzing
enter_workspace
exec python3 "$root/tests/fuzz/hunt.py" "$@"
