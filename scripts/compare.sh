#!/usr/bin/env bash
# Usage: ./scripts/compare.sh A B [options]
#
# Compare two run folders: a table in the terminal, and a page with both maps and charts.
# Performs the set-up if needed. Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
#
#   --page FILE      file of the page (default: compare.html in B)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command compare "$@"
