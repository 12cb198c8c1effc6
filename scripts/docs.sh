#!/usr/bin/env bash
# Usage: ./scripts/docs.sh [--serve]
#
# Build the documentation as a site in build/site, with the API from the docstrings and a search.
# Performs the set-up if needed, with mkdocs; the site itself needs no network.
# Exit code: 0 success, 1 a warning or failure, 2 invalid usage, 130 interrupted.
#
#   --serve  then serve it at http://127.0.0.1:8800 until Ctrl-C (the search does not work in files)
#   --help   this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
answer_help "$@"
if [[ $* && $* != --serve ]]; then
    usage >&2
    printf "error: unknown option '%s'\n" "$1" >&2
    exit 2
fi
set_up docs
cd "$root"
log=$root/build/site.log
if ! .venv/bin/python3 -W ignore::DeprecationWarning -m mkdocs build --quiet --strict >"$log" 2>&1; then
    cat "$log" >&2
    fail "the site has not been built"
fi
print_line "build/site/index.html"
[[ -z $* ]] || exec .venv/bin/python3 -m http.server --bind 127.0.0.1 --directory build/site 8800
