#include <apsis/integrate/schedule.hpp>

#include <apsis/method/precision.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>

namespace apsis {

/// Zero pattern of the coefficients; indices 0 … s with 0 for u^n.
struct schedule::pattern {
  int stages = 0;                 ///< rows
  int result = 0;                 ///< row of u^{n+1}: the last one, or the one before the embedded solution
  matrix<char> weight;            ///< u_j enters u_k
  matrix<char> transport;         ///< T(u_j) enters u_k
  matrix<char> collision;         ///< Q(u_j) enters u_k, k > j
  std::vector<char> solve;        ///< stage k has an implicit part
  std::vector<char> recoverable;  ///< Δt d_kk Q(u_k) = u_k − explicit part
  std::vector<char> is_initial;   ///< u_k = u^n
};

class schedule::builder {
 public:
  builder(const pattern& p, schedule& out)
      : p_(p), out_(out), buffer_(p.weight.rows(), -1), done_(p.weight.rows(), p.weight.rows()) {
    buffer_[0] = 0;
  }

  void run() {
    for (int k = 1; k <= p_.stages; ++k) {
      if (p_.is_initial[index(k)] && k < p_.result) {
        buffer_[index(k)] = 0;
      } else {
        open(k);
        if (p_.solve[index(k)]) solve(k);
      }
      spread(k);
      release_unneeded(k);
    }
    out_.result_ = buffer_[index(p_.result)];
    if (p_.stages > p_.result) out_.embedded_ = buffer_[index(p_.stages)];
    out_.buffers_ = static_cast<int>(in_use_.size()) + 1;
  }

 private:
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }
  char& done(int k, int j) { return done_(index(k), index(j)); }
  bool weighs(int k, int j) const { return p_.weight(index(k), index(j)) != 0; }
  bool carries_transport(int k, int j) const { return p_.transport(index(k), index(j)) != 0; }
  bool carries_collision(int k, int j) const { return p_.collision(index(k), index(j)) != 0; }

  int acquire() {
    for (std::size_t b = 0; b < in_use_.size(); ++b) {
      if (!in_use_[b]) {
        in_use_[b] = true;
        return static_cast<int>(b) + 1;
      }
    }
    in_use_.push_back(true);
    return static_cast<int>(in_use_.size());
  }

  void release(int buffer) {
    if (buffer > 0) in_use_[index(buffer) - 1] = false;
  }

  void emit(action what, int j, std::vector<contribution> to) {
    out_.instructions_.push_back({what, j, buffer_[index(j)], std::move(to)});
  }

  bool needed_by(int last, int j, int except) const {
    for (int k = j + 1; k <= last; ++k)
      if (k != except && weighs(k, j) && !done_(index(k), index(j))) return true;
    return j >= p_.result;
  }
  bool needed_after(int j, int except) const { return needed_by(p_.stages, j, except); }

  /// Assigns a buffer to accumulator k and adds the pending multiples of u^n and of known stages.
  void open(int k) {
    if (buffer_[index(k)] >= 0) return;
    bool fresh = true;
    for (int j = 1; j < known_; ++j) {  // a stage with no further use hands over its buffer
      const bool waits = weighs(k, j) && !done(k, j) && buffer_[index(j)] > 0;
      // A stage that only the embedded solution still needs comes first, too: the order of the sum does not
      // depend on the embedded solution.
      const int last = k <= p_.result ? p_.result : p_.stages;
      if (!waits || carries_transport(k, j) || carries_collision(k, j) || needed_by(last, j, k)) continue;
      const bool is_last_use = !needed_after(j, k);
      buffer_[index(k)] = is_last_use ? buffer_[index(j)] : acquire();
      emit(action::add_transport, j, {{k, buffer_[index(k)], {term::weight}, true}});
      done(k, j) = 1;
      if (is_last_use) buffer_[index(j)] = -1;
      fresh = false;
      break;
    }
    if (fresh) buffer_[index(k)] = acquire();
    for (int j = 0; j < known_; ++j) {
      if (!weighs(k, j) || done(k, j) || buffer_[index(j)] < 0) continue;
      emit(action::add_transport, j, {{k, buffer_[index(k)], {term::weight}, fresh}});
      done(k, j) = 1;
      fresh = false;
      if (j > 0 && !needed_after(j, -1)) drop(j);
    }
    if (fresh) pending_fresh_ = k;
  }

  bool take_fresh(int k) {
    const bool fresh = pending_fresh_ == k;
    if (fresh) pending_fresh_ = -1;
    return fresh;
  }

  void drop(int j) {
    release(buffer_[index(j)]);
    buffer_[index(j)] = -1;
  }

  /// Schedules the solve of stage k; off-diagonal multiples of Q(u_k) need its explicit part first.
  void solve(int k) {
    if (p_.recoverable[index(k)]) {
      std::vector<contribution> before;
      for (int m = k + 1; m <= p_.stages; ++m) {
        if (!carries_collision(m, k)) continue;
        known_ = k;  // u_k itself is not known yet
        open(m);
        before.push_back({m, buffer_[index(m)], {term::minus_explicit}, take_fresh(m)});
      }
      if (!before.empty()) emit(action::add_transport, k, std::move(before));
    }
    emit(action::solve_collision, k, {});
    ++out_.solves_;
  }

  /// Adds T(u_k) and multiples of u_k to every accumulator that is open or must be opened now.
  void spread(int k) {
    std::vector<contribution> to, collisions;
    bool transport = false;
    for (int m = k + 1; m <= p_.stages; ++m) {
      const bool collides = carries_collision(m, k);
      const bool recovered = collides && p_.recoverable[index(k)];
      if (carries_transport(m, k) || collides) {
        known_ = k;
        open(m);
      }
      if (buffer_[index(m)] < 0) continue;
      std::vector<term> terms;
      if (weighs(m, k) && !done(m, k)) terms.push_back(term::weight);
      if (recovered) terms.push_back(term::plus_solved);
      if (!terms.empty()) to.push_back({m, buffer_[index(m)], terms, take_fresh(m)});
      if (collides && !recovered)
        collisions.push_back({m, buffer_[index(m)], {term::collision}, take_fresh(m)});
      done(m, k) = 1;
      transport = transport || carries_transport(m, k);
    }
    if (!to.empty()) emit(action::add_transport, k, std::move(to));
    if (!collisions.empty()) {
      emit(action::add_collision, k, std::move(collisions));
      ++out_.collisions_;
    }
    if (transport) ++out_.transports_;
    known_ = k + 1;
  }

  void release_unneeded(int k) {
    for (int j = 1; j <= k; ++j)
      if (buffer_[index(j)] > 0 && !needed_after(j, -1)) drop(j);
  }

  const pattern& p_;
  schedule& out_;
  std::vector<int> buffer_;  // buffer of each stage or accumulator, −1 for none
  matrix<char> done_;
  std::vector<bool> in_use_;
  int known_ = 1;           // stages below this index are known
  int pending_fresh_ = -1;  // accumulator that is open but not yet written to
};

template <class Real>
schedule::schedule(const shu_osher_form<Real>& m, bool embedded) {
  const std::size_t s = m.stages();
  pattern p;
  p.stages = static_cast<int>(s);
  p.result = embedded ? p.stages - 1 : p.stages;
  p.weight = p.transport = p.collision = matrix<char>(s + 1, s + 1);
  p.solve = p.recoverable = p.is_initial = std::vector<char>(s + 1, 0);
  const auto initial = initial_weights(m);
  for (std::size_t k = 0; k < s; ++k) {
    bool stages_enter = false;
    for (std::size_t j = 0; j < k; ++j) {
      p.transport(k + 1, j + 1) = static_cast<char>(m.W(k, j) != Real(0));
      p.collision(k + 1, j + 1) = static_cast<char>(m.D(k, j) != Real(0));
      p.weight(k + 1, j + 1) = static_cast<char>(m.P(k, j) != Real(0) || m.W(k, j) != Real(0));
      stages_enter = stages_enter || p.weight(k + 1, j + 1) != 0 || p.collision(k + 1, j + 1) != 0;
    }
    p.weight(k + 1, 0) = static_cast<char>(initial[k] != Real(0));
    p.solve[k + 1] = static_cast<char>(m.D(k, k) != Real(0) || m.ddot[k] != Real(0));
    p.recoverable[k + 1] = static_cast<char>(m.D(k, k) != Real(0) && m.ddot[k] == Real(0));
    p.is_initial[k + 1] = static_cast<char>(!stages_enter && p.solve[k + 1] == 0);
  }
  builder(p, *this).run();
}

int buffers_of(const time_integrator& m) {
  return schedule(m.starter().coefficients<double>()).buffers() + m.kept_states;
}

template schedule::schedule(const shu_osher_form<double>&, bool);
template schedule::schedule(const shu_osher_form<long double>&, bool);
template schedule::schedule(const shu_osher_form<mp_real>&, bool);

}  // namespace apsis
