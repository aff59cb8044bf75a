#!/usr/bin/env bash
# Installs missing packages, builds and runs the benchmarks.
# Usage: share/bench.sh [NAME …] [-- Google Benchmark arguments …]   (NAME: sonar odometry graph sim map; default: all)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
names=()
while [ $# -gt 0 ] && [ "$1" != "--" ]; do names+=("$1"); shift; done
[ $# -gt 0 ] && shift
[ ${#names[@]} -gt 0 ] || names=(sonar odometry graph sim map)

"$root/share/build.sh" release "${names[@]/#/bench_}"
cd "$root"
for name in "${names[@]}"; do
  echo "== Benchmark: $name"
  "build/release/bin/bench_$name" "$@"
done
