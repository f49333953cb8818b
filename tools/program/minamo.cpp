#include "tools/program/minamo.hpp"

int main(int argc, char** argv) { return minamo::run(argc, argv); }
