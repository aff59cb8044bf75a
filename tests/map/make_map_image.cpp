// make_map_image FILE: writes a small map in the present version of its stream form, as tests/data keeps it.

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <iostream>

#include "sample_map.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_map_image FILE\n";
    return 2;
  }
  mrpt::io::CFileOutputStream file(argv[1]);
  auto archive = mrpt::serialization::archiveFrom(file);
  archive << s2s::test::sampleMap();
  return 0;
}
