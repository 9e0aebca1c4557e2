float halved(float x) {
  return 0.5 * x;
}
