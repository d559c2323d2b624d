// Lanes of a kernel. A kernel of a device is a struct in internal/kernels/, with the name of its file:
//   struct combine {
//     static constexpr const char* name = "combine";
//     struct arguments { ... };                                        plain numbers and pointers
//     template <class Lane> static APSIS_FORMULA void run(const Lane& lane, const arguments& of);
//   };
// A launch runs it in blocks of lanes. Each lane calls run() with the same arguments. Lanes of a block share
// memory. They wait for each other in lane.wait(), which all lanes must call equally often. Blocks are
// independent of each other. Between two calls of wait(), lanes run in any order: other lanes may read a
// number that a lane writes only after the next wait().
//
//   lane.index(), lane.count()    number of this lane in its block, and number of lanes
//   lane.block(), lane.blocks()   number of its block, and number of blocks
//   lane.shared()                 memory of the block with the numbers that the launch requests, undefined
//   lane.wait()                   waits for all lanes of the block
//
// Kernels consist of formulas (exec/number.hpp) on doubles, and are compiled for the host as well, where the
// tests run them (backends/teams.cpp). They include no header of the standard library.
#pragma once

#include <apsis/exec/number.hpp>

/// Attribute of lambda expressions that are part of a kernel.
#define APSIS_INLINED __attribute__((always_inline))

namespace apsis::device_code {

#if defined(__NVPTX__)

extern __attribute__((address_space(3))) double shared_numbers[];

/// A lane of a graphics processor.
struct lane {
  APSIS_FORMULA int index() const { return static_cast<int>(__nvvm_read_ptx_sreg_tid_x()); }
  APSIS_FORMULA int count() const { return static_cast<int>(__nvvm_read_ptx_sreg_ntid_x()); }
  APSIS_FORMULA int block() const { return static_cast<int>(__nvvm_read_ptx_sreg_ctaid_x()); }
  APSIS_FORMULA int blocks() const { return static_cast<int>(__nvvm_read_ptx_sreg_nctaid_x()); }
  APSIS_FORMULA double* shared() const { return (double*)shared_numbers; }
  APSIS_FORMULA void wait() const { __syncthreads(); }
};

#elif defined(__AMDGCN__)

extern __attribute__((address_space(3))) double shared_numbers[];

/// A lane of a graphics processor. The dispatch packet contains the sizes of the launch at bytes 4 and 12
/// (HSA Platform System Architecture Specification 1.2, 2.9.6).
struct lane {
  APSIS_FORMULA int index() const { return static_cast<int>(__builtin_amdgcn_workitem_id_x()); }
  APSIS_FORMULA int count() const {
    return *(const unsigned short __attribute__((address_space(4)))*)(packet() + 4);
  }
  APSIS_FORMULA int block() const { return static_cast<int>(__builtin_amdgcn_workgroup_id_x()); }
  APSIS_FORMULA int blocks() const {
    const auto lanes = *(const unsigned __attribute__((address_space(4)))*)(packet() + 12);
    return static_cast<int>(lanes) / count();
  }
  APSIS_FORMULA double* shared() const { return (double*)shared_numbers; }
  APSIS_FORMULA void wait() const {
    __builtin_amdgcn_fence(__ATOMIC_RELEASE, "workgroup");
    __builtin_amdgcn_s_barrier();
    __builtin_amdgcn_fence(__ATOMIC_ACQUIRE, "workgroup");
  }

 private:
  static APSIS_FORMULA const char __attribute__((address_space(4))) * packet() {
    return (const char __attribute__((address_space(4)))*)__builtin_amdgcn_dispatch_ptr();
  }
};

#endif

}  // namespace apsis::device_code
