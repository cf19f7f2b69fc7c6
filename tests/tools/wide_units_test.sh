#!/usr/bin/env bash
# wide_units_test.sh OBJECT...: units compiled for AVX2 or AVX-512 define no inline function or template instance that
# the linker may merge with another unit's. It keeps any one of the copies: the AVX-512 one would then run on a
# processor without it, and crash there. So those units keep what they use in unnamed namespaces, or under a name with
# the instruction set in it, as the Eigen of linalg's fronts has it: such copies are of one instruction set all.
set -euo pipefail

units=0
for object in "$@"; do
  [[ $object =~ _(avx2|avx512)\.cpp\. ]] || continue
  own=_${BASH_REMATCH[1]}
  units=$((units + 1))
  # W, V and u: weak functions, weak objects, unique globals. DW.ref. is a pointer to the C++ runtime, not code.
  if shared=$(nm --defined-only "$object" | grep -E ' [WVu] ' | grep -vE "$own|DW\.ref\." | c++filt); then
    printf '%s: may be merged with copies for plainer processors:\n%s\n' "$object" "$shared" >&2
    exit 1
  fi
done
((units > 0)) || { echo "no unit named *_avx* among $# objects" >&2; exit 1; }
echo "$units units share no function"
