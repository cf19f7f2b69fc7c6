#!/bin/bash
# Runs every fuzz target for a time, two at once; one line each, exit code 1 when one finds a crash.
#
#     tools/run_fuzz.sh SECONDS [TARGET...]       for example: tools/run_fuzz.sh 60 msh vtu
#
# Targets are built by: cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_programs
# What is found, and the grown corpus, goes to build/fuzz/found/TARGET; the seeds in fuzz/corpus stay as they are.
set -u
cd "$(dirname "$0")/.." || exit 2
ASAN_SYMBOLIZER_PATH=${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer-16 llvm-symbolizer | head -1)}
if [ -z "$ASAN_SYMBOLIZER_PATH" ]; then  # stacks without names say nothing of who is to blame
  echo "run_fuzz: no llvm-symbolizer-16 (tools/install test)" >&2
  exit 2
fi
export ASAN_SYMBOLIZER_PATH
seconds=${1:?usage: tools/run_fuzz.sh SECONDS [TARGET...]}
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for program in build/fuzz/bin/fuzz_*; do
    [ -x "$program" ] && targets+=("${program##*/fuzz_}")
  done
fi
[ ${#targets[@]} -gt 0 ] || { echo "run_fuzz: no targets in build/fuzz/bin (cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_programs)" >&2; exit 2; }

run_one() {
  local target=$1 seconds=$2 folder=build/fuzz/found/$1
  local log=$folder/log program=build/fuzz/bin/fuzz_$target
  rm -rf "$folder" && mkdir -p "$folder/corpus" "$folder/crashes"
  # A single input gets 10 s and 2 GiB.
  local options=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1
    -artifact_prefix="$folder/crashes/")
  if reads_hdf5 "$target"; then
    options+=($of_hdf5 -fork=1 -ignore_crashes=1 -ignore_ooms=1)
    export ASAN_OPTIONS=$asan_of_hdf5
  fi
  "$program" "${options[@]}" "$folder/corpus" "fuzz/corpus/$target" >"$log" 2>&1
  local status=$? input whose found=""
  if reads_hdf5 "$target"; then
    grep -q '^#[0-9]*: cov:' "$log" && status=0  # with -fork it tells of the last crash alone
    local -A count=()
    for input in "$folder"/crashes/*; do
      [ -e "$input" ] || continue
      whose=$(judge "$program" "$input")
      count[$whose]=$((${count[$whose]:-0} + 1))
      echo "$whose: $input" >>"$folder/judged"
    done
    [ "${count[ours]:-0}" -gt 0 ] && status=1
    for whose in ours hdf5 unclear harmless; do
      [ "${count[$whose]:-0}" -gt 0 ] && found+=", $(words_of "$whose"): ${count[$whose]}"
    done
    [ -n "$found" ] && found+=" (listed in $folder/judged)"
  fi
  local runs coverage
  runs=$(grep -oE '^(#[0-9]+|stat::number_of_executed_units: *[0-9]+)' "$log" | tail -1 | grep -oE '[0-9]+$')
  coverage=$(grep -o 'cov: [0-9]*' "$log" | tail -1)
  local line="${runs:-0} runs, ${coverage:-no coverage}$found"
  if [ $status -eq 0 ]; then echo "fuzz_$target: ok, $line"; else echo "fuzz_$target: FAILED, $line, see $log"; return 1; fi
}

# HDF5 asks for absurd sizes and copes when it does not get them, and loses memory of its own when it refuses a file. It
# also crashes on hostile files, of which a search always finds more. So the search goes on, each crash is judged
# afterwards, and only one that is surely ours makes the target fail; the rest is counted and listed.
reads_hdf5() { [[ $1 =~ ^(vtkhdf|recording|record)$ ]]; }
export of_hdf5='-detect_leaks=0 -malloc_limit_mb=1000000'
export asan_of_hdf5=allocator_may_return_null=1:detect_leaks=0

# Whose fault an input is, which is run alone, twice: the second time the heap lies otherwise, so that what HDF5 has
# written astray does not come out as a fault of ours. "ours" has to be ours both times.
judge() {
  local program=$1 input=$2 first
  first=$(judge_run "$program" "$input" "$asan_of_hdf5")
  if [ "$first" = ours ] && [ "$(judge_run "$program" "$input" "$asan_of_hdf5:redzone=512:max_redzone=2048")" != ours ]; then
    first=unclear
  fi
  echo "$first"
}

judge_run() {
  local program=$1 input=$2 asan=$3 log=$2.log
  local run=("$program" $of_hdf5 -timeout=10 -rss_limit_mb=2048 "$input")
  if ASAN_OPTIONS=$asan "${run[@]}" >"$log" 2>&1; then
    echo harmless
    return
  fi
  # What libFuzzer shows of a run out of memory is what lies on the heap, not who asked for too much.
  if grep -q 'libFuzzer: out-of-memory' "$log" &&
    ! ASAN_OPTIONS=$asan:allocator_may_return_null=0:max_allocation_size_mb=2048 "${run[@]}" >"$log.asked" 2>&1; then
    log+=.asked
  fi
  tools/whose_crash.sh "$log"
}

words_of() {
  case $1 in
    ours) echo "crash in our code" ;;
    hdf5) echo "crash inside HDF5" ;;
    unclear) echo "crash without saying where" ;;
    harmless) echo "crashed after others, not alone" ;;
  esac
}

export -f run_one reads_hdf5 judge judge_run words_of
printf '%s\n' "${targets[@]}" | xargs -P 2 -I{} bash -c 'run_one "$1" "$2"' _ {} "$seconds" || exit 1
