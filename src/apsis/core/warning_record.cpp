#include <apsis/core/warning_record.hpp>

#include <algorithm>

namespace apsis {
namespace {

struct all_records {
  std::mutex mutex;
  std::vector<warning_record*> records;
};

all_records& live_records() {
  static all_records instance;
  return instance;
}

}  // namespace

warning_record::warning_record() {
  const std::lock_guard lock(live_records().mutex);
  live_records().records.push_back(this);
}

warning_record::~warning_record() {
  const std::lock_guard lock(live_records().mutex);
  std::erase(live_records().records, this);
}

std::vector<std::string> warning_record::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void warning_record::add_to_all(const std::string& message) {
  const std::lock_guard lock(live_records().mutex);
  for (warning_record* record : live_records().records) {
    const std::lock_guard own(record->mutex_);
    record->messages_.push_back(message);
  }
}

}  // namespace apsis
