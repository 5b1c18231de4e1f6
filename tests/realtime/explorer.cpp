#include "realtime/explorer.h"

#include <ucontext.h>

#include <exception>
#include <memory>

namespace heel::test {
namespace {

constexpr std::size_t kStackBytes = 256 * 1024;

struct Choice {
  std::size_t taken, count;
};

struct Coroutine {
  ucontext_t context{};
  std::vector<char> stack;
  std::function<void()> body;
  bool ended = false;
};

/// Which threads have ever accessed and written a variable, a bit for each.
struct Uses {
  unsigned accessed = 0, written = 0;
};

/// Thrown where a thread uses a variable that others were thought to have for themselves: what was explored
/// until then may have left out choices.
struct StartAgain {};

/// One exploration; explore() is not called from two threads.
struct Exploration {
  std::vector<Choice> choices;  ///< of this run; the next run repeats them but for the last
  std::size_t place = 0;
  std::vector<Uses> uses;  ///< by variable
  std::size_t variables = 0;
  Planted planted = Planted::Nothing;
  std::array<Coroutine, kMostThreads> threads;
  std::array<VectorClock, kMostThreads> clocks{};
  std::size_t running = 0;
  bool in_threads = false;
  ucontext_t main{};
  std::exception_ptr failure;
};

Exploration* g_exploration = nullptr;

void run_thread() {
  Exploration& e = *g_exploration;
  Coroutine& self = e.threads[e.running];
  try {
    self.body();
  } catch (...) {
    e.failure = std::current_exception();
  }
  self.ended = true;
  swapcontext(&self.context, &e.main);
}

void prepare(Coroutine& thread, std::function<void()> body) {
  thread.body = std::move(body);
  thread.ended = false;
  thread.stack.resize(kStackBytes);
  getcontext(&thread.context);
  thread.context.uc_stack.ss_sp = thread.stack.data();
  thread.context.uc_stack.ss_size = thread.stack.size();
  thread.context.uc_link = nullptr;
  makecontext(&thread.context, run_thread, 0);
}

/// Runs the threads to their ends along the choices; the check comes after both.
void run_once(Exploration& e, const OneRun& run) {
  e.place = 0;
  e.clocks = {};
  e.failure = nullptr;
  for (std::size_t i = 0; i < run.threads.size(); ++i) prepare(e.threads[i], run.threads[i]);
  const auto unended = [&] {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < run.threads.size(); ++i)
      if (!e.threads[i].ended) found.push_back(i);
    return found;
  };
  e.in_threads = true;
  for (std::vector<std::size_t> ready = unended(); !ready.empty() && !e.failure; ready = unended()) {
    e.running = ready[explorer::choose(ready.size())];
    swapcontext(&e.main, &e.threads[e.running].context);
  }
  e.in_threads = false;
  if (e.failure) std::rethrow_exception(e.failure);
  // Who has joined both threads knows all that they did.
  for (const VectorClock& clock : std::array(e.clocks)) explorer::join(e.clocks[0], clock);
  e.running = 0;
  run.at_end();
}

/// False: every choice has been taken.
bool next_choices(std::vector<Choice>& choices) {
  while (!choices.empty() && choices.back().taken + 1 == choices.back().count) choices.pop_back();
  if (choices.empty()) return false;
  ++choices.back().taken;
  return true;
}

}  // namespace

namespace explorer {

std::size_t this_thread() {
  return g_exploration->running;
}

VectorClock& clock() {
  return g_exploration->clocks[g_exploration->running];
}

bool synchronises_as(std::memory_order order, bool acquire) {
  if (g_exploration->planted == (acquire ? Planted::NoAcquire : Planted::NoRelease)) return false;
  return order == std::memory_order_acq_rel || order == std::memory_order_seq_cst ||
         order == (acquire ? std::memory_order_acquire : std::memory_order_release);
}

std::size_t new_variable() {
  Exploration& e = *g_exploration;
  if (e.uses.size() == e.variables) e.uses.emplace_back();
  return e.variables++;
}

void switch_point(std::size_t variable, bool writes) {
  Exploration& e = *g_exploration;
  if (!e.in_threads) return;
  Uses& uses = e.uses[variable];
  const unsigned self = 1U << e.running;
  const bool known = (uses.accessed & self) != 0 && (!writes || (uses.written & self) != 0);
  uses.accessed |= self;
  if (writes) uses.written |= self;
  const unsigned others = (writes ? uses.accessed : uses.written) & ~self;
  if (!known && (uses.accessed & ~self) != 0) throw StartAgain();
  if (others != 0) swapcontext(&e.threads[e.running].context, &e.main);
}

std::size_t choose(std::size_t count) {
  Exploration& e = *g_exploration;
  if (count < 2 || !e.in_threads) return 0;
  if (e.place == e.choices.size()) e.choices.push_back({0, count});
  return e.choices[e.place++].taken;
}

void fail(const std::string& what) {
  throw Violation(what);
}

}  // namespace explorer

Explored explore(const std::function<OneRun()>& make_run, Planted planted) {
  const auto exploration = std::make_unique<Exploration>();
  exploration->planted = planted;
  g_exploration = exploration.get();
  Explored explored;
  bool more = true;
  while (more) {
    ++explored.runs;
    exploration->variables = 0;
    try {
      run_once(*exploration, make_run());
    } catch (const StartAgain&) {
      exploration->choices.clear();
      explored.runs = 0;
      continue;
    } catch (const Violation& violation) {
      explored.violation = violation.what();
      break;
    }
    more = next_choices(exploration->choices);
  }
  g_exploration = nullptr;
  return explored;
}

}  // namespace heel::test
