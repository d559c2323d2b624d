#pragma once

#include <functional>

namespace apsis {

/// Threads that loops over cells may use; 0 asks for all cores.
void set_threads(int n);
int threads();

/// Runs body(k) for k = 0 … n−1, in any order, on all threads. Each k writes its own data, so results do not
/// depend on the number of threads. An exception leaves once all have stopped; of several, the one of the
/// smallest k is thrown.
void parallel_for(int n, const std::function<void(int)>& body);

/// The same for jobs of different length (whole runs): a thread that is free takes the next k. Loops inside a
/// job run on its own thread. Once a job has failed no new one begins.
void parallel_tasks(int n, const std::function<void(int)>& body);

}  // namespace apsis
