#!/usr/bin/env python3
"""tools/whose_crash.sh on stacks as libFuzzer and the sanitizers print them."""

import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools" / "whose_crash.sh"

MEMCPY = "__interceptor_memcpy (/r/build/fuzz/bin/fuzz_vtkhdf+0xd96d0) (BuildId: 77)"
MEMCMP = "MemcmpInterceptorCommon(void*, int (*)(void const*, void const*, unsigned long)) (/r/build/fuzz/bin/fuzz_vtkhdf+0x1)"
HDF5 = "H5O__attr_exists (/lib/x86_64-linux-gnu/libhdf5_serial.so.103+0x19518c) (BuildId: e9)"
HDF5_NAMELESS = " (/lib/x86_64-linux-gnu/libhdf5_serial.so.103+0x190f18) (BuildId: e9)"
OURS = "rhexis::mesh::io::Hdf5Input::has(long, char const*) const /r/build/fuzz/../../src/mesh/io/hdf5_input.cpp:68:7"
OURS_INLINE = "operator() /r/build/fuzz/../../src/mesh/io/vtkhdf_reader.cpp:83:37"
VECTOR = "std::vector<int, std::allocator<int> >::at(unsigned long) /usr/include/c++/12/bits/stl_vector.h:1142"
TERMINATE = "std::terminate() ../../../../../src/libstdc++-v3/libsupc++/eh_terminate.cc:58"
TARGET = "LLVMFuzzerTestOneInput /r/build/fuzz/../../fuzz/vtkhdf.cpp:7:28"
DRIVER = "fuzzer::Fuzzer::ExecuteCallback(unsigned char const*, unsigned long) (/r/build/fuzz/bin/fuzz_vtkhdf+0xa4ec0)"


def stack(*frames):
    return "".join(f"    #{k} 0x55580f6396d{k} in {frame}\n" for k, frame in enumerate(frames))


def whose(report):
    with tempfile.NamedTemporaryFile("w") as log:
        log.write("INFO: Seed: 1\n==7==ERROR: AddressSanitizer: of some kind\n" + report)
        log.flush()
        return subprocess.run([SCRIPT, log.name], capture_output=True, text=True, check=True).stdout.strip()


class WhoseCrash(unittest.TestCase):
    def test_inside_hdf5_whoever_called_it(self):
        for inner in ([], [MEMCPY], [MEMCMP], ["__sanitizer_print_stack_trace (/r/bin/fuzz+0x1)", DRIVER, "<null> (/libc.so.6+0x1)"]):
            for hdf5 in (HDF5, HDF5_NAMELESS):
                self.assertEqual(whose(stack(*inner, hdf5, OURS, TARGET, DRIVER)), "hdf5")

    def test_inside_our_code_whatever_it_called(self):
        for inner in ([], [MEMCPY], [VECTOR], ["raise (/libc.so.6+0x1)", "abort (/libc.so.6+0x2)", TERMINATE]):
            for ours in (OURS, OURS_INLINE):
                self.assertEqual(whose(stack(*inner, ours, TARGET, DRIVER)), "ours")

    def test_called_back_by_hdf5_is_ours(self):
        self.assertEqual(whose(stack(VECTOR, OURS_INLINE, HDF5, OURS, TARGET, DRIVER)), "ours")

    def test_the_first_stack_counts_alone(self):
        self.assertEqual(whose(stack(MEMCPY, HDF5, OURS) + "\nallocated here:\n" + stack("malloc (/r/bin+0x1)", OURS)), "hdf5")
        self.assertEqual(whose(stack(OURS, TARGET) + "\nfreed here:\n" + stack("free (/r/bin+0x1)", HDF5)), "ours")
        self.assertEqual(whose(stack(DRIVER) + "\nallocated here:\n" + stack(OURS)), "unclear")

    def test_undefined_behaviour_is_ours(self):
        self.assertEqual(whose("../../src/a.cpp:1:2: runtime error: signed integer overflow\n" + stack(HDF5, OURS)), "ours")

    def test_without_a_stack_it_is_unclear(self):
        self.assertEqual(whose(""), "unclear")
        self.assertEqual(whose(stack(TERMINATE, DRIVER)), "unclear")
        heap = stack("operator new(unsigned long) (/r/build/fuzz/bin/fuzz_vtkhdf+0x19259d)", DRIVER, "main (/r/bin+0x1)")
        self.assertEqual(whose("Live Heap Allocations:\n" + heap + "\n" + heap), "unclear")


if __name__ == "__main__":
    unittest.main()
