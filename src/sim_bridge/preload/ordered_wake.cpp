// Preloaded into a node of roscpp: its threads that sleep in simulated time wake up one after another.
//
// Threads that are due at the same instant, such as the control loop and the map updates of move_base, look
// at the clock once a millisecond, each for itself, so that their order is chance. With this library a thread
// whose sleep is over waits until those have had their turn that are due as well and were created before it,
// and until all others rest. What the clock wakes otherwise, as timers do, comes first. Meanwhile the thread
// is ready to run, so that the simulator sees that the node does not rest.
//
// Use: env LD_PRELOAD=libordered_wake.so NODE

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

namespace ros
{
// As in roscpp_core.
struct Time
{
  uint32_t sec;
  uint32_t nsec;
  static Time now();
  static bool useSystemTime();
};

struct Duration
{
  int32_t sec;
  int32_t nsec;
  bool sleep() const;
};
}  // namespace ros

namespace
{
using Clock = std::chrono::steady_clock;

// Time for which all others must rest: more than two of the looks at the clock that timers take.
constexpr std::chrono::microseconds QUIET{2500};
// Time after which a thread goes on in any case: others may never rest.
constexpr std::chrono::seconds PATIENCE{2};

std::mutex g_mutex;
// Simulated times until which threads sleep or wait for their turn [ns], by number; the kernel counts up.
std::map<int, int64_t> g_sleeping;

int64_t nanoseconds(int64_t sec, int64_t nsec)
{
  return sec * 1000000000 + nsec;
}

int64_t simulated_time()
{
  const ros::Time now = ros::Time::now();
  return nanoseconds(now.sec, now.nsec);
}

// Whether a thread waits for something, by the state in /proc/self/task/TID/stat, after the name in brackets.
bool is_resting(int thread)
{
  char path[64];
  char text[128];
  std::snprintf(path, sizeof(path), "/proc/self/task/%d/stat", thread);
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0)
  {
    return true;  // it has ended
  }
  const ssize_t count = read(file, text, sizeof(text) - 1);
  close(file);
  text[count > 0 ? count : 0] = '\0';
  const char* bracket = std::strrchr(text, ')');
  return bracket == nullptr || std::strchr("SItTXZ", bracket[2]) != nullptr;
}

// Whether all threads rest that do not sleep in simulated time.
bool do_others_rest()
{
  DIR* folder = opendir("/proc/self/task");
  bool all = true;
  while (dirent* entry = folder != nullptr && all ? readdir(folder) : nullptr)
  {
    const int thread = std::atoi(entry->d_name);
    all = thread == 0 || g_sleeping.count(thread) != 0 || is_resting(thread);
  }
  if (folder != nullptr)
  {
    closedir(folder);
  }
  return all;
}

bool is_first_due(int self)
{
  const int64_t now = simulated_time();
  for (const auto& sleeper : g_sleeping)
  {
    if (sleeper.first == self || sleeper.second <= now)
    {
      return sleeper.first == self;
    }
  }
  return true;
}

void wait_for_turn(int self)
{
  std::unique_lock<std::mutex> lock(g_mutex);
  const Clock::time_point begin = Clock::now();
  Clock::time_point quiet_since = begin;
  for (;;)
  {
    const Clock::time_point now = Clock::now();
    if (!is_first_due(self) || !do_others_rest())
    {
      quiet_since = Clock::now();  // this thread may not have run for a while since the loop began
    }
    if (now - quiet_since >= QUIET || now - begin >= PATIENCE)
    {
      break;
    }
    lock.unlock();
    sched_yield();
    lock.lock();
  }
  g_sleeping.erase(self);
}
}  // namespace

bool ros::Duration::sleep() const
{
  using Sleep = bool (*)(const Duration*);
  static const auto original = reinterpret_cast<Sleep>(dlsym(RTLD_NEXT, "_ZNK3ros8Duration5sleepEv"));
  if (Time::useSystemTime())
  {
    return original(this);
  }
  const int self = static_cast<int>(syscall(SYS_gettid));
  {
    std::lock_guard<std::mutex> lock(g_mutex);
    g_sleeping[self] = simulated_time() + nanoseconds(sec, nsec);
  }
  const bool result = original(this);
  wait_for_turn(self);
  return result;
}
