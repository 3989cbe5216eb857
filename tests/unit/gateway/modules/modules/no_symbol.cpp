// A library that is no module: it exports a function of its own, and no descriptor.
extern "C" __attribute__((visibility("default"))) int something_else();
int something_else() {
  return 1;
}
