# Kernels of devices (device/internal/lane.hpp): one text for the host and for graphics processors. Sets
# APSIS_DEVICE_GENERATED to the sources with the table of kernels for the host and the code for processors.
# The latter is empty without clang++-19 and its linker, which compile it without a toolkit of a vendor.
#
# A file of internal/kernels/ defines the kernel of its name.
find_program(APSIS_DEVICE_COMPILER clang++-19 DOC "clang++ that compiles kernels for graphics processors")
find_program(APSIS_DEVICE_LINKER ld.lld-19 DOC "linker of kernels for processors of AMD")
set(APSIS_DEVICE_PROCESSORS "sm_70;gfx90a;gfx942" CACHE STRING "Graphics processors that kernels are compiled for")

set(kernels_folder ${CMAKE_CURRENT_SOURCE_DIR}/device/internal/kernels)
file(GLOB kernel_files CONFIGURE_DEPENDS ${kernels_folder}/*.hpp)
list(SORT kernel_files)
set(kernel_includes "")
set(kernel_entries "")
set(kernel_rows "")
foreach(file IN LISTS kernel_files)
  get_filename_component(stem ${file} NAME_WE)
  string(APPEND kernel_includes "#include <apsis/device/internal/kernels/${stem}.hpp>\n")
  string(APPEND kernel_entries "ENTRY(${stem})\n")
  string(APPEND kernel_rows "    row<${stem}>(),\n")
endforeach()

set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
file(CONFIGURE OUTPUT ${generated}/host_kernels.cpp @ONLY CONTENT
"// Generated from the files of device/internal/kernels/; do not edit.
#include <apsis/device/internal/kernel_table.hpp>
@kernel_includes@
namespace apsis {
namespace {
using namespace kernels;
template <class Kernel>
constexpr host_kernel row() {
  return {Kernel::name, sizeof(typename Kernel::arguments), [](const team_lane& lane, const void* of) {
            Kernel::run(lane, *static_cast<const typename Kernel::arguments*>(of));
          }};
}
constexpr host_kernel all[] = {
@kernel_rows@};
}  // namespace

std::span<const host_kernel> host_kernels() {
  return all;
}
}  // namespace apsis
")
file(CONFIGURE OUTPUT ${generated}/device_kernels.cu.cpp @ONLY CONTENT
"// Generated from the files of device/internal/kernels/ for graphics processors; do not edit.
@kernel_includes@
#if defined(__NVPTX__)
#define KERNEL __attribute__((nvptx_kernel))
#else
#define KERNEL __attribute__((amdgpu_kernel))
#endif
#define ENTRY(name) \\
  extern \"C\" KERNEL void name(const apsis::kernels::name::arguments of) { \\
    apsis::kernels::name::run(apsis::device_code::lane(), of); \\
  }
@kernel_entries@")

# Kernels belong to the component kinetic.
if("kinetic" IN_LIST apsis_components AND NOT APSIS_DEVICE_COMPILER)
  message(STATUS "Kernels for graphics processors are not built (clang++-19 was not found)")
elseif("kinetic" IN_LIST apsis_components AND NOT APSIS_DEVICE_LINKER)
  message(STATUS "Kernels for graphics processors of AMD are not built (ld.lld-19 was not found)")
endif()
set(code_objects "")
set(code_symbols "")
set(code_rows "")
set(code_files "")
if(APSIS_DEVICE_COMPILER)
  foreach(processor IN LISTS APSIS_DEVICE_PROCESSORS)
    set(flags -std=c++20 -O3 -ffp-contract=off -fno-exceptions -fno-rtti -nogpulib -nostdinc++
        -Wall -Wextra -Werror -Wno-unused-command-line-argument -I${PROJECT_SOURCE_DIR}/src)
    if(processor MATCHES "^sm_")
      list(PREPEND flags --target=nvptx64-nvidia-cuda -march=${processor} --cuda-feature=+ptx63 -S)
      set(ending ptx)
    elseif(APSIS_DEVICE_LINKER)
      list(PREPEND flags --target=amdgcn-amd-amdhsa -mcpu=${processor} --ld-path=${APSIS_DEVICE_LINKER})
      set(ending elf)
    else()
      continue()
    endif()
    set(code ${generated}/${processor}.${ending})
    add_custom_command(OUTPUT ${code}
      COMMAND ${APSIS_DEVICE_COMPILER} ${flags} -MD -MT ${code} -MF ${code}.d -o ${code} ${generated}/device_kernels.cu.cpp
      DEPENDS ${generated}/device_kernels.cu.cpp DEPFILE ${code}.d VERBATIM
      COMMENT "Compiling kernels for ${processor}")
    list(APPEND code_files ${code})
    string(APPEND code_objects
"asm(R\"(
  .section .rodata
  .balign 4096
apsis_${processor}:
  .incbin \"${code}\"
apsis_${processor}_end:
  .byte 0
  .global apsis_${processor}, apsis_${processor}_end
  .text
)\");
extern \"C\" const unsigned char apsis_${processor}[], apsis_${processor}_end[];
")
    string(APPEND code_rows "    {\"${processor}\", apsis_${processor}, static_cast<std::size_t>(apsis_${processor}_end - apsis_${processor})},\n")
  endforeach()
endif()
file(CONFIGURE OUTPUT ${generated}/device_code.cpp @ONLY CONTENT
"// Generated; do not edit. Code of the kernels for graphics processors.
#include <apsis/device/internal/kernel_table.hpp>

#include <vector>

@code_objects@
namespace apsis {
std::span<const device_code_object> device_code_objects() {
  static const std::vector<device_code_object> all = {
@code_rows@  };
  return all;
}
}  // namespace apsis
")
set_property(SOURCE ${generated}/device_code.cpp APPEND PROPERTY OBJECT_DEPENDS "${code_files}")
set_source_files_properties(${generated}/device_code.cpp ${generated}/host_kernels.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
# Host kernels only check those of the devices, on small grids.
set_source_files_properties(${generated}/host_kernels.cpp PROPERTIES COMPILE_OPTIONS ${APSIS_QUICKLY_BUILT})
set(APSIS_DEVICE_GENERATED ${generated}/host_kernels.cpp ${generated}/device_code.cpp)
