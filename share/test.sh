#!/usr/bin/env bash
# Installs missing packages, builds, checks the format and runs all tests.
# Usage: share/test.sh [--preset release|debug|asan] [ctest arguments …]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
preset=release
if [ "${1:-}" = "--preset" ]; then preset=$2; shift 2; fi

"$root/share/build.sh" "$preset"
cd "$root"
echo "== Format: clang-format"
git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
echo "== Tests: preset $preset"
ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" "$@"
