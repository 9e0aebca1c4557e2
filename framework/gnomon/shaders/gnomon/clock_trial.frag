// Arithmetic whose amount is known and whose result is used: nothing can be left out.
uniform int iterations;
out float result;

void main() {
  float x = fract(gl_FragCoord.x * 0.37 + gl_FragCoord.y * 0.71);
  for (int i = 0; i < iterations; ++i) x = fract(x * 3.9 + 0.1);
  result = x;
}
