#!/usr/bin/env bash
# Estimates from all recordings of a list with GNU parallel on this machine, and merges the results.
# usage: parallel.sh LIST.csv RESULTS SHARDS TABLE.csv
set -euo pipefail
list=$1 results=$2 shards=$3 table=$4
run=${RUN:-$(dirname "$0")/../../scripts/run}  # RUN: the tools of another build
seq "$shards" | parallel "$run" estimate --manifest "$list" --output "$results" --shard "{}/$shards" --resume --quiet
"$run" estimate --manifest "$list" --output "$results" --merge "$table"
