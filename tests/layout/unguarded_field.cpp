// Must not pass the lint: a field is touched without the lock that guards it. When it passes, nobody watches the locks.
#include "gateway/threads/turn_lock.hpp"

namespace rmac::gateway {

class Unguarded {
 public:
  void touch() { ++count_; }

 private:
  TurnLock lock_;
  int count_ GUARDED_BY(lock_) = 0;
};

}  // namespace rmac::gateway
