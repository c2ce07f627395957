#include "lab/point_run.h"
#include "lab/program.h"

int main(int argc, char** argv) {
  return atlaswire::run_program("atlas-lab", argc, argv, [](int count, char** words) {
    return atlaswire::lab::run_lab(count, words, atlaswire::lab::run_point);
  });
}
