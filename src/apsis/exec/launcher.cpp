#include <apsis/exec/launcher.hpp>

#include <cstdlib>
#include <initializer_list>
#include <string>

namespace apsis {

int launched_count() {
  // SLURM_NTASKS alone does not count: it is set in a batch script too, which is a single process.
  const bool by_slurm = std::getenv("PMI_RANK") != nullptr || std::getenv("PMIX_RANK") != nullptr;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", by_slurm ? "SLURM_NTASKS" : ""})
    if (const char* text = std::getenv(name); text != nullptr)
      if (const int count = std::atoi(text); count > 0) return count;
  return 1;
}

int launched_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (const char* text = std::getenv(name); text != nullptr) return std::atoi(text);
  return 0;
}

}  // namespace apsis
