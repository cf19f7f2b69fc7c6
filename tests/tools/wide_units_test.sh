#!/usr/bin/env bash
# wide_units_test.sh OBJECT...: units compiled for AVX2 or AVX-512 define no inline function or template instance that
# the linker may merge with another unit's. It keeps any one of the copies: the AVX-512 one would then run on a
# processor without it, and crash there. So those units keep what they use in unnamed namespaces.
set -euo pipefail

wide=()
for object in "$@"; do
  [[ $object == *_avx* ]] && wide+=("$object")
done
((${#wide[@]} > 0)) || { echo "no unit named *_avx* among $# objects" >&2; exit 1; }

# W, V and u: weak functions, weak objects, unique globals.
if shared=$(nm -C --defined-only "${wide[@]}" | grep -E ' [WVu] '); then
  printf 'may be merged with copies for plainer processors:\n%s\n' "$shared" >&2
  exit 1
fi
echo "${#wide[@]} units share no function"
