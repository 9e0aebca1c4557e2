// Carries the ELF note but exports no entries.
#include <gnomon/plugin.h>

GNOMON_PLUGIN_NOTE
