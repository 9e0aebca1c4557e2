// A named guard against a numerical hard case: on, unless a test switches it off to show that the guard is needed.
#define GNOMON_DEFENCE(name) true
