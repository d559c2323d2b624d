#include <apsis/mesh/shared_rows.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/profile.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

namespace apsis {

shared_rows::shared_rows(std::shared_ptr<communicator> processes, std::vector<shared_row> all)
    : processes_(std::move(processes)), any_(!all.empty()) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::map<int, peer> peers;
  const auto with = [&](int rank) -> peer& {
    return peers.try_emplace(rank, peer{rank, {}, {}}).first->second;
  };
  for (const auto& [key, from, to] : all) {
    if (from == processes_->rank()) with(to).given.push_back(key);
    if (to == processes_->rank()) with(from).wanted.push_back(key);
  }
  for (auto& [rank, one] : peers) peers_.push_back(std::move(one));
}

void shared_rows::exchange(int length, const std::function<const double*(int key)>& row_of) {
  if (!any_) return;
  length_ = length;
  std::size_t given = 0, wanted = 0;
  for (const peer& one : peers_) {
    given += one.given.size();
    wanted += one.wanted.size();
  }
  const profile::section timed(kernel::halo, static_cast<double>(given) * length,
                               {0.0, 2.0 * sizeof(double)});
  sent_.resize(given * at(length));
  received_.resize(wanted * at(length));
  std::vector<message> sent, received;
  std::span<double> to_send(sent_), to_receive(received_);
  for (const peer& one : peers_) {
    const auto out = to_send.first(one.given.size() * at(length)),
               in = to_receive.first(one.wanted.size() * at(length));
    for (std::size_t k = 0; k < one.given.size(); ++k)
      std::copy_n(row_of(one.given[k]), length, out.data() + k * at(length));
    if (!out.empty()) sent.push_back({one.rank, out});
    if (!in.empty()) received.push_back({one.rank, in});
    to_send = to_send.subspan(out.size());
    to_receive = to_receive.subspan(in.size());
  }
  processes_->begin_exchange(sent, received);
  processes_->finish_exchange();
}

int shared_rows::place_of(int key) const {
  int before = 0;
  for (const peer& one : peers_) {
    const auto found = std::lower_bound(one.wanted.begin(), one.wanted.end(), key);
    if (found != one.wanted.end() && *found == key)
      return before + static_cast<int>(found - one.wanted.begin());
    before += static_cast<int>(one.wanted.size());
  }
  throw std::out_of_range("a row that no other process sends");
}

}  // namespace apsis
