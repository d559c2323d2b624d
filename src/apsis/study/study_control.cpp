#include <apsis/study/study_control.hpp>

#include <apsis/exec/interruption.hpp>
#include <apsis/exec/parallel.hpp>

#include <mutex>

namespace apsis {

void study_control::report(double fraction, const std::string& what) const {
  if (progress) progress(fraction, what);
}

void study_control::check() const {
  if (stop && stop()) throw study_interrupted();
}

void run_all(const study_control& control, const std::string& what, int count,
             const std::function<void(int)>& body) {
  std::mutex guard;
  int done = 0;
  control.report(0.0, what);
  parallel_tasks(count, [&](int k) {
    control.check();
    const interruptible before_steps([&control] { control.check(); });
    body(k);
    const std::lock_guard lock(guard);
    control.report(static_cast<double>(++done) / count, what);
  });
}

}  // namespace apsis
