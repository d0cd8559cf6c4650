#pragma once
// Threads that wait for loops. Those of OpenMP spin for milliseconds after each loop, which took a third of the
// processor's time where loops and file work alternate, and slows the thread that works on the same core.

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace dubsar {

/// One team for the whole program. Any thread may call.
class WorkerTeam {
 public:
  /// Never destroyed: its threads wait until the program ends.
  static WorkerTeam& instance();

  /// Calls work() on up to `threads` threads at the same time, the caller among them, and returns when all have
  /// returned. `work` takes what is to be done from a common counter until nothing is left, and throws nothing; who
  /// comes too late to find something is not waited for. By the caller alone where it is itself at work for the team,
  /// or where another thread has the team.
  void run(int threads, const std::function<void()>& work);

 private:
  /// A worker takes what it is offered, or the caller takes it back: whoever is first.
  struct Worker {
    std::atomic<const std::function<void()>*> offer{nullptr};
  };

  void grow(std::size_t workers);
  void serve(Worker& worker);

  std::mutex busy_;                               ///< held while the team is at work
  std::vector<std::unique_ptr<Worker>> workers_;  ///< those of running threads
  std::atomic<int> at_work_{0};                   ///< offers that were neither taken back nor finished
};

}  // namespace dubsar
