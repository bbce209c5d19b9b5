// dlib's random forest on the data of regression_benchmark --export: prints the CPU time of each training
// [s] and, last, RMSE on the test set [Pa]. Usage: dlib_forest_peer TRAIN.csv TEST.csv REPETITIONS

#include <dlib/random_forest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace {

struct Data {
  std::vector<dlib::matrix<double, 0, 1>> code;
  std::vector<double> pressure;
};

Data read(const char* path) {
  Data data;
  std::ifstream file(path);
  std::string header;
  std::getline(file, header);
  double code, pressure, curvature;
  char comma;
  while (file >> code >> comma >> pressure >> comma >> curvature) {
    dlib::matrix<double, 0, 1> input(1);
    input(0) = code;
    data.code.push_back(input);
    data.pressure.push_back(pressure);
  }
  return data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const Data train = read(argv[1]), test = read(argv[2]);
  dlib::random_forest_regression_trainer<dlib::dense_feature_extractor> trainer;
  trainer.set_num_trees(150);
  trainer.set_min_samples_per_leaf(5);
  trainer.set_feature_subsampling_fraction(1.0);
  dlib::random_forest_regression_function<dlib::dense_feature_extractor> forest;
  for (int i = 0; i < std::atoi(argv[3]); ++i) {
    const std::clock_t start = std::clock();
    forest = trainer.train(train.code, train.pressure);
    std::printf("%.6f\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  double squares = 0;
  for (std::size_t i = 0; i < test.code.size(); ++i) {
    squares += std::pow(forest(test.code[i]) - test.pressure[i], 2);
  }
  std::printf("%.6f\n", std::sqrt(squares / static_cast<double>(test.code.size())));
  return 0;
}
