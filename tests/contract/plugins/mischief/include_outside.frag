#include "../trace/trace.frag"
