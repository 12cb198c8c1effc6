#!/usr/bin/env bash
# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command home_builder build_home "$@"
