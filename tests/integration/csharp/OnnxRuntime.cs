// What OnnxRuntimeWalkNet.cs uses of Microsoft.ML.OnnxRuntime, as declarations alone, so that a compiler can judge it.
using System;
using System.Collections;
using System.Collections.Generic;
using Microsoft.ML.OnnxRuntime.Tensors;

namespace Microsoft.ML.OnnxRuntime.Tensors
{
    public abstract class Tensor<T> : IEnumerable<T>
    {
        public IEnumerator<T> GetEnumerator() { return null; }
        IEnumerator IEnumerable.GetEnumerator() { return null; }
    }
    public class DenseTensor<T> : Tensor<T>
    {
        public DenseTensor(T[] memory, int[] dimensions) { }
    }
}

namespace Microsoft.ML.OnnxRuntime
{
    public class SessionOptions : IDisposable
    {
        public int IntraOpNumThreads { get; set; }
        public void Dispose() { }
    }
    public class NodeMetadata { }
    public class NamedOnnxValue
    {
        public static NamedOnnxValue CreateFromTensor<T>(string name, Tensor<T> value) { return null; }
        public Tensor<T> AsTensor<T>() { return null; }
    }
    public class DisposableNamedOnnxValue : NamedOnnxValue { }
    public interface IDisposableReadOnlyCollection<T> : IReadOnlyCollection<T>, IDisposable { }
    public class InferenceSession : IDisposable
    {
        public InferenceSession(string path, SessionOptions options) { }
        public IReadOnlyDictionary<string, NodeMetadata> InputMetadata { get { return null; } }
        public IDisposableReadOnlyCollection<DisposableNamedOnnxValue> Run(
            IReadOnlyCollection<NamedOnnxValue> inputs, IReadOnlyCollection<string> outputs) { return null; }
        public void Dispose() { }
    }
}
