#pragma once

// Says which lock guards what, in the words of clang's thread-safety analysis: `./test.sh --lint` has clang-tidy prove
// it, and g++ sees none of it. std::mutex has no such words under libstdc++, so that the locks below this folder do.
// https://clang.llvm.org/docs/ThreadSafetyAnalysis.html

#if defined(__clang__)
#define RMAC_THREAD_SAFETY(attribute) __attribute__((attribute))
#else
#define RMAC_THREAD_SAFETY(attribute)
#endif

/// A class of locks.
#define CAPABILITY(name) RMAC_THREAD_SAFETY(capability(name))
/// A class that holds a lock from its constructor to its destructor.
#define SCOPED_CAPABILITY RMAC_THREAD_SAFETY(scoped_lockable)
/// A field that is read and written only by who holds the lock.
#define GUARDED_BY(lock) RMAC_THREAD_SAFETY(guarded_by(lock))
/// The caller holds the lock.
#define REQUIRES(...) RMAC_THREAD_SAFETY(requires_capability(__VA_ARGS__))
/// The caller must not hold the lock: the function takes it.
#define EXCLUDES(...) RMAC_THREAD_SAFETY(locks_excluded(__VA_ARGS__))
#define ACQUIRE(...) RMAC_THREAD_SAFETY(acquire_capability(__VA_ARGS__))
#define TRY_ACQUIRE(...) RMAC_THREAD_SAFETY(try_acquire_capability(__VA_ARGS__))
#define RELEASE(...) RMAC_THREAD_SAFETY(release_capability(__VA_ARGS__))
/// The body of a lock itself, which rests on a std::mutex that has no words.
#define NO_THREAD_SAFETY_ANALYSIS RMAC_THREAD_SAFETY(no_thread_safety_analysis)
