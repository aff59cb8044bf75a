#!/usr/bin/env bash
# Installs missing packages, builds and runs the benchmarks.
# Usage: share/bench.sh [NAME …] [-- Google Benchmark arguments …]
#        (NAME: sonar odometry graph sim map mapper; default: all)
# mapper is the whole of seabed-sky-map on 35 s of the canal with a full LiDAR (128x1024@20) and both sonars, beside
# only reading the same rawlog, and once more without the sonars, whose share of a core it prints; the survey is
# simulated once into out/bench/survey.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
names=()
while [ $# -gt 0 ] && [ "$1" != "--" ]; do names+=("$1"); shift; done
[ $# -gt 0 ] && shift
[ ${#names[@]} -gt 0 ] || names=(sonar odometry graph sim map mapper)

"$root/share/build.sh" release "${names[@]/#/bench_}"
cd "$root"
for name in "${names[@]}"; do
  echo "== Benchmark: $name"
  if [ "$name" = mapper ]; then
    survey=out/bench/survey
    if [ ! -e $survey/truth/extrinsics.ini ]; then
      "$root/share/build.sh" release simulate-survey
      build/release/bin/simulate-survey --scene share/scenes/canal.ini --lidar 128x1024@20 --duration 35 --output $survey
    fi
    build/release/bin/bench_mapper $survey --output out/bench/map
  else
    "build/release/bin/bench_$name" "$@"
  fi
done
