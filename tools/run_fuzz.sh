#!/bin/bash
# Runs every fuzz target for a time, two at once; one line each, exit code 1 when one finds a crash.
#
#     tools/run_fuzz.sh SECONDS [TARGET...]       for example: tools/run_fuzz.sh 60 msh vtu
#
# Targets are built by: cmake --preset fuzz && cmake --build --preset fuzz
# What is found, and the grown corpus, goes to build/fuzz/found/TARGET; the seeds in fuzz/corpus stay as they are.
set -u
export ASAN_SYMBOLIZER_PATH=${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer-16 llvm-symbolizer | head -1)}
cd "$(dirname "$0")/.."
seconds=${1:?usage: tools/run_fuzz.sh SECONDS [TARGET...]}
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for program in build/fuzz/bin/fuzz_*; do
    [ -x "$program" ] && targets+=("${program##*/fuzz_}")
  done
fi
[ ${#targets[@]} -gt 0 ] || { echo "run_fuzz: no targets in build/fuzz/bin (cmake --preset fuzz && cmake --build --preset fuzz)" >&2; exit 2; }

run_one() {
  local target=$1 seconds=$2 folder=build/fuzz/found/$1
  local log=$folder/log program=build/fuzz/bin/fuzz_$target
  rm -rf "$folder" && mkdir -p "$folder/corpus" "$folder/crashes"
  # A single input gets 10 s and 2 GiB.
  local options=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1
    -artifact_prefix="$folder/crashes/")
  if reads_hdf5 "$target"; then
    # HDF5 asks for absurd sizes and copes when it does not get them, and loses memory of its own when it refuses a file.
    # It also crashes: then the search goes on, and afterwards each crash is looked at.
    export ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0
    options+=(-detect_leaks=0 -malloc_limit_mb=1000000 -fork=1 -ignore_crashes=1 -ignore_ooms=1)
  fi
  "$program" "${options[@]}" "$folder/corpus" "fuzz/corpus/$target" >"$log" 2>&1
  local status=$? exempt=0 input
  if reads_hdf5 "$target"; then
    grep -q '^#[0-9]*: cov:' "$log" && status=0  # with -fork it tells of the last crash alone
    for input in "$folder"/crashes/*; do
      [ -e "$input" ] || continue
      "$program" -detect_leaks=0 -malloc_limit_mb=1000000 -timeout=10 "$input" >"$input.log" 2>&1 && continue
      if inside_hdf5 "$input.log"; then exempt=$((exempt + 1)); else status=1; fi
    done
  fi
  local runs coverage
  runs=$(grep -oE '^(#[0-9]+|stat::number_of_executed_units: *[0-9]+)' "$log" | tail -1 | grep -oE '[0-9]+$')
  coverage=$(grep -o 'cov: [0-9]*' "$log" | tail -1)
  local line="${runs:-0} runs, ${coverage:-no coverage}"
  [ $exempt -gt 0 ] && line+=", $exempt inputs crash inside HDF5 (exempt, see fuzz/vtkhdf.cpp)"
  if [ $status -eq 0 ]; then echo "fuzz_$target: ok, $line"; else echo "fuzz_$target: FAILED, $line, see $log"; return 1; fi
}

reads_hdf5() { [ "$1" = vtkhdf ] || [ "$1" = recording ]; }

# True when the innermost frame outside of the sanitizer and the C library belongs to HDF5.
inside_hdf5() {
  grep -E '^ *#[0-9]+ 0x' "$1" | grep -vE 'compiler-rt|__interceptor|__asan|__sanitizer|/libc\.so|sysdeps|in (__(mem|str)[a-z_0-9]*|raise|abort|malloc|free|calloc|realloc) ' |
    head -1 | grep -q 'libhdf5'
}

export -f run_one reads_hdf5 inside_hdf5
printf '%s\n' "${targets[@]}" | xargs -P 2 -I{} bash -c 'run_one "$1" "$2"' _ {} "$seconds" || exit 1
