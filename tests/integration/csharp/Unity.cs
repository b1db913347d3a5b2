// What UnityWalkNet.cs uses of Unity and its inference engine, as declarations alone, so that a compiler can judge it.
using System.Collections.Generic;

namespace UnityEngine
{
    public class Object { }
    public class MonoBehaviour : Object { }
    public class TextAsset : Object { public byte[] bytes { get { return null; } } }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }
    public struct Quaternion
    {
        public static Quaternion LookRotation(Vector3 forward, Vector3 upwards) { return new Quaternion(); }
    }
    public class Transform : Object
    {
        public Vector3 position { get; set; }
        public Vector3 localPosition { get; set; }
        public Vector3 eulerAngles { get; set; }
        public Quaternion localRotation { get; set; }
    }
    public static class Time { public static float fixedDeltaTime { get; set; } }
}

namespace Unity.InferenceEngine
{
    public class ModelAsset : UnityEngine.Object { }
    public class Model
    {
        public struct Input { public string name; }
        public List<Input> inputs;
    }
    public static class ModelLoader { public static Model Load(ModelAsset asset) { return null; } }
    public enum BackendType { GPUCompute, CPU, GPUPixel }
    public struct TensorShape { public TensorShape(params int[] sizes) { } }
    public abstract class Tensor : System.IDisposable { public void Dispose() { } }
    public class Tensor<T> : Tensor where T : struct
    {
        public Tensor(TensorShape shape, T[] data, int start = 0) { }
        public T[] DownloadToArray() { return null; }
    }
    public class Worker : System.IDisposable
    {
        public Worker(Model model, BackendType backend) { }
        public void SetInput(string name, Tensor tensor) { }
        public void Schedule() { }
        public Tensor PeekOutput(string name) { return null; }
        public void Dispose() { }
    }
}
