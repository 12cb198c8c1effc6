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

// Time after a change of the clock in which timers look at it twice.
constexpr std::chrono::microseconds LOOKED{2500};
// Time for which the others must rest: what a thread has woken is ready to run at once.
constexpr std::chrono::microseconds QUIET{300};
// Looks in succession at which all of them must rest.
constexpr int LOOKS = 3;
// Time after which a thread goes on in any case: others may never rest.
constexpr std::chrono::seconds PATIENCE{2};

std::mutex g_mutex;
// Simulated times until which threads sleep or wait for their turn [ns], by number; the kernel counts up.
std::map<int, int64_t> g_sleeping;
// Simulated time at which threads were last due [ns], and since when.
int64_t g_instant = -1;
Clock::time_point g_instant_since;

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

// Number of a thread that neither sleeps in simulated time nor rests; 0 if there is none.
int find_busy()
{
  DIR* folder = opendir("/proc/self/task");
  int busy = 0;
  while (dirent* entry = folder != nullptr && busy == 0 ? readdir(folder) : nullptr)
  {
    const int thread = std::atoi(entry->d_name);
    busy = thread == 0 || g_sleeping.count(thread) != 0 || is_resting(thread) ? 0 : thread;
  }
  if (folder != nullptr)
  {
    closedir(folder);
  }
  return busy;
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
  int busy_before = 0;
  int rests = 0;
  for (;;)
  {
    const Clock::time_point now = Clock::now();
    if (simulated_time() != g_instant)
    {
      g_instant = simulated_time();
      g_instant_since = now;
    }
    const bool is_first = is_first_due(self);
    const int busy = is_first ? find_busy() : 0;
    // A thread that is seen running once has looked at the clock only.
    if (!is_first || (busy != 0 && busy == busy_before))
    {
      quiet_since = Clock::now();  // this thread may not have run for a while since the loop began
    }
    busy_before = busy;
    rests = is_first && busy == 0 ? rests + 1 : 0;
    if ((now - g_instant_since >= LOOKED && now - quiet_since >= QUIET && rests >= LOOKS) || now - begin >= PATIENCE)
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
