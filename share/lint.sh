#!/usr/bin/env bash
# clang-format and clang-tidy over our own code.
# Usage: share/lint.sh [FILE.cpp …]   (without arguments: every source file; takes a while)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
"$root/share/install-packages.sh"
cd "$root"
echo "== Format: clang-format"
git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
echo "== Lint: clang-tidy"
cmake --preset tidy >/dev/null
if [ $# -gt 0 ]; then files=("$@"); else mapfile -t files < <(git ls-files '*.cpp'); fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p build/tidy --quiet
