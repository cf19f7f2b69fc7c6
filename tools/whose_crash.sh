#!/bin/bash
# Says whose fault the crash is that a fuzz target reports: "ours", "hdf5" or "unclear".
#
#     tools/whose_crash.sh LOG
#
# What is nearer to the fault in the first stack of the report decides, our code or HDF5: the sanitizers, the fuzzer, the
# C and C++ libraries that lie inside of it work for the one or the other. A stack with neither is unclear, as is a report
# without one. HDF5 is not instrumented for undefined behaviour, so that what UndefinedBehaviorSanitizer finds is ours.
set -u
log=${1:?usage: tools/whose_crash.sh LOG}
if grep -q ': runtime error: ' "$log"; then
  echo ours
  exit
fi
frame=$(awk '/^ *#[0-9]+ 0x/ { print; seen = 1; next } seen { exit }' "$log" |
  grep -m 1 -E 'libhdf5| rhexis::|build/fuzz/\.\./\.\./(src|fuzz)/')
case $frame in
  *libhdf5*) echo hdf5 ;;
  ?*) echo ours ;;
  *) echo unclear ;;
esac
