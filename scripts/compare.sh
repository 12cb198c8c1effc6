#!/usr/bin/env bash
# Usage: ./scripts/compare.sh A B [options]
#
# Puts the folders of two runs side by side: a table in the terminal, and a page with both maps and charts.
# Sets everything up first if need be. Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --page FILE      where the page goes (default: compare.html in B)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command compare "$@"
