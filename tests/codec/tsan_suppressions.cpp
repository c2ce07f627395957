/// ThreadSanitizer cannot see the atomics by which libavcodec, built without it, hands slices to its threads
/// and takes them back; it then takes one thread's table writes for a race with the next picture's. Only
/// reports with a frame inside that library are dropped.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() { return "race:libavcodec.so\n"; }
