#!/usr/bin/env bash
# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
set_up fuzzing
enter_workspace
exec python3 "$root/tests/fuzz/hunt.py" "$@"
