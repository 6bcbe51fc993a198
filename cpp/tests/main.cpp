// What Python cannot see: the parts of the core that no binding exposes.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
