// A module on its own: nothing beside the common interface.

#define INSTANCE Harness
#include "interface.h"
