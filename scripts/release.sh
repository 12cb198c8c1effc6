#!/usr/bin/env bash
# Usage: ./scripts/release.sh [--output FOLDER]
#
# Make the archive of the version in CITATION.cff from the current commit, reproducible byte for byte, and print its
# SHA-256. Refuses a tree with changes, and versions that differ between CITATION.cff, CHANGELOG.md, the package.xml
# files and the Dockerfile. To publish: git tag -a vVERSION, then this script.
# Exit code: 0 success, 1 failure, 2 invalid input.
#
#   --output FOLDER  folder of the archive (default: ./dist)
#   --help           this text

# shellcheck source=scripts/lib.sh
. "$(dirname -- "$(readlink -f -- "$0")")/lib.sh"

version_of_release() {
    local version others
    version=$(sed -n 's/^version: *//p' CITATION.cff)
    grep -q "^## \[$version\]" CHANGELOG.md || fail "CHANGELOG.md has no section of version $version"
    others=$(git ls-files 'src/*package.xml' tests/package.xml | xargs grep -L "<version>$version</version>" || true)
    grep -qF "image.version=\"$version\"" docker/Dockerfile || others+=" docker/Dockerfile"
    [[ -z $others ]] || fail "not of version $version: ${others//$'\n'/ }"
    print_line "$version"
}

make_archive() { # FILE VERSION: time stamps are the commit's, and gzip adds none
    git archive --format=tar --prefix="home-service-robot-$2/" HEAD | gzip --no-name --best >"$1"
}

answer_help "$@"
output=$PWD/dist
if (($#)); then
    [[ $1 == --output && $# == 2 ]] || { usage >&2 && exit 2; }
    output=$(readlink -m -- "$2")
fi
cd "$root"
[[ -z $(git status --porcelain) ]] || fail "the tree has changes that are not committed"
version=$(version_of_release)
mkdir -p "$output"
archive=$output/home-service-robot-$version.tar.gz
make_archive "$archive" "$version"
make_archive "$archive.again" "$version"
cmp "$archive" "$archive.again" || fail "the archive is not the same twice"
rm "$archive.again"
(cd "$output" && sha256sum "${archive##*/}")
